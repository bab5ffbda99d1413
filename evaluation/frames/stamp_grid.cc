#include "evaluation/frames/stamp_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/frames/camera_statistics.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kOnGrid = 0.1;  // of a period
constexpr double kFewOnGrid = 0.8;
constexpr int kLeastFraction = 4;
constexpr double kNearOther = 0.02;
constexpr std::size_t kLongestPeriodSpan = 30;
constexpr std::size_t kFewestForFractions = 20;
constexpr double kFarPeriods = 1e15;
constexpr double kMissingFrom =
    0.75;  // an interval longer by so much of a period has an empty point
constexpr std::size_t kPhaseFrames = 15;
constexpr std::size_t kLeastPhaseFrames = 5;
constexpr double kLeastStep = 0.05;  // of a period

using Frames = std::span<const StampedFrame>;

double grid_interval_ms(Frames frames, std::size_t i) {
  return difference_ms(frames[i].sensor.count(), frames[i - 1].sensor.count());
}

std::vector<double> advancing_intervals(Frames frames) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double interval = grid_interval_ms(frames, i);
    if (interval > 0) intervals.push_back(interval);
  }
  return intervals;
}

double whole_periods(double interval, double period_ms) {
  return std::clamp(std::round(interval / period_ms), -kFarPeriods, kFarPeriods);
}

double on_grid_share(const std::vector<double>& intervals, double period_ms) {
  const auto is_on = [period_ms](double interval) {
    const double periods = interval / period_ms;
    return periods > 0.5 && std::abs(periods - std::round(periods)) < kOnGrid;
  };
  return static_cast<double>(std::ranges::count_if(intervals, is_on)) /
         static_cast<double>(intervals.size());
}

// Whether some intervals are one period: else nothing shows that a shorter one exists.
bool occurs(const std::vector<double>& intervals, double period_ms) {
  constexpr double kFewestOfPeriod = 0.1;
  const auto count = std::ranges::count_if(intervals, [period_ms](double interval) {
    return std::abs(interval / period_ms - 1) < kOnGrid;
  });
  return static_cast<double>(count) >= kFewestOfPeriod * static_cast<double>(intervals.size());
}

// The median over spans of some frames, since alternating intervals have no middle one.
double refined_period_ms(Frames frames, double period_ms) {
  const std::size_t span = std::min(kLongestPeriodSpan, frames.size() / 4);
  if (span < 2) return period_ms;
  std::vector<double> points(1);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    points.push_back(points.back() + whole_periods(grid_interval_ms(frames, i), period_ms));
  }
  std::vector<double> means;
  for (std::size_t i = span; i < frames.size(); ++i) {
    const double count = points[i] - points[i - span];
    const double length = difference_ms(frames[i].sensor.count(), frames[i - span].sensor.count());
    if (count > 0 && length > 0) means.push_back(length / count);
  }
  return means.empty() ? period_ms : median(std::move(means));
}

// One of the intervals: the mean of two could be of no grid.
double middle_interval(std::vector<double> intervals) {
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>((intervals.size() - 1) / 2);
  std::ranges::nth_element(intervals, middle);
  return *middle;
}

double grid_period_of(Frames frames, const std::vector<double>& intervals,
                      std::optional<double> other_ms) {
  const double middle = middle_interval(intervals);
  const double own = refined_period_ms(frames, middle);
  const double own_share = on_grid_share(intervals, own);
  if (own_share >= kFewOnGrid || intervals.size() < kFewestForFractions) return own;
  const auto fits = [&](double period_ms) {
    return on_grid_share(intervals, period_ms) >= kMostOnGrid;
  };
  for (int fraction = 2; fraction <= kLeastFraction; ++fraction) {
    const double part = refined_period_ms(frames, middle / fraction);
    if (fits(part) && occurs(intervals, part)) return part;
  }
  if (other_ms) {
    const double theirs = refined_period_ms(frames, *other_ms);
    if (std::abs(theirs / *other_ms - 1) < kNearOther && fits(theirs)) return theirs;
  }
  return own;
}

void place_by_intervals(Frames frames, StampGrid& grid) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double interval = grid_interval_ms(frames, i);
    const double whole = whole_periods(interval, grid.period_ms);
    grid.points.push_back(grid.points.back() + std::llround(whole));
    const double missing = std::ceil(interval / grid.period_ms - kMissingFrom) - 1;
    grid.missing.push_back(std::llround(std::clamp(missing, 0.0, kFarPeriods)));
  }
}

// A frame that is late or early by more than half a period leaves one point empty and shares
// another one: no frame is missing.
void take_back_empty_points(std::vector<std::int64_t>& missing) {
  for (std::size_t i = 0; i < missing.size(); ++i) {
    for (std::size_t away = 1; missing[i] < 0 && away <= kPhaseFrames; ++away) {
      for (const std::size_t near :
           {i - std::min(i, away), std::min(i + away, missing.size() - 1)}) {
        if (missing[i] >= 0 || missing[near] <= 0) continue;
        ++missing[i];
        --missing[near];
      }
    }
    missing[i] = std::max<std::int64_t>(0, missing[i]);
  }
}

void place_by_phase(Frames frames, StampGrid& grid) {
  std::vector<double> phases = {0};  // of the last frames; a ring
  double phase = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double since = difference_ms(frames[i].sensor.count(), frames[0].sensor.count());
    const double whole = whole_periods(since - phase, grid.period_ms);
    const std::int64_t point = std::llround(whole);
    grid.missing.push_back(point - grid.points.back() - 1);
    grid.points.push_back(point);
    const double own = since - whole * grid.period_ms;
    if (phases.size() < kPhaseFrames) {
      phases.push_back(own);
    } else {
      phases[i % kPhaseFrames] = own;
    }
    phase = median(phases);
  }
  take_back_empty_points(grid.missing);
}

// From one interval to the next, a missing frame no more than a period.
double correlation_of_intervals(Frames frames, double period_ms) {
  double product = 0;
  double square = 0;
  double before = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double deviation =
        std::clamp(grid_interval_ms(frames, i) - period_ms, -period_ms, period_ms);
    product += before * deviation;
    square += deviation * deviation;
    before = deviation;
  }
  return square > 0 ? product / square : 0;
}

void note_deviations(Frames frames, StampGrid& grid) {
  std::vector<double> deviations;
  std::vector<double> sizes;
  std::size_t on_grid = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double interval = grid_interval_ms(frames, i);
    const double whole = whole_periods(interval, grid.period_ms);
    const double deviation = interval - whole * grid.period_ms;
    deviations.push_back(deviation);
    sizes.push_back(std::abs(deviation));
    if (whole > 0 && sizes.back() < kOnGrid * grid.period_ms) ++on_grid;
  }
  grid.interval_jitter_ms = standard_deviation(deviations);
  grid.scatter_ms = kSigmasOfMedian * median(std::move(sizes)) / std::sqrt(2.0);
  grid.on_grid_share = static_cast<double>(on_grid) / static_cast<double>(deviations.size());
}

// What a frame is later than its point, each frame's own.
std::vector<double> residuals_of(Frames frames, const StampGrid& grid) {
  std::vector<double> residuals;
  residuals.reserve(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    residuals.push_back(difference_ms(frames[i].sensor.count(), frames[0].sensor.count()) -
                        static_cast<double>(grid.points[i]) * grid.period_ms);
  }
  return residuals;
}

double median_of_stretch(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  return median(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                    values.begin() + static_cast<std::ptrdiff_t>(end)));
}

// How far apart the medians of neighbouring stretches usually are: jitter may last for many frames.
double usual_move_ms(const std::vector<double>& residuals, double period_ms) {
  std::vector<double> moves;
  for (std::size_t i = kPhaseFrames; i + kPhaseFrames <= residuals.size(); i += kPhaseFrames) {
    moves.push_back(std::abs(std::remainder(median_of_stretch(residuals, i, i + kPhaseFrames) -
                                                median_of_stretch(residuals, i - kPhaseFrames, i),
                                            period_ms)));
  }
  return moves.empty() ? 0 : kSigmasOfMedian * median(std::move(moves));
}

void find_steps(Frames frames, StampGrid& grid) {
  constexpr double kMoveSigmas = 6;
  const std::vector<double> residuals = residuals_of(frames, grid);
  const double least = std::max({kLeastStep * grid.period_ms, kStepSigmas * grid.scatter_ms,
                                 kMoveSigmas * usual_move_ms(residuals, grid.period_ms)});
  std::size_t settled = 0;  // no step before this frame
  for (std::size_t i = 1; i < residuals.size(); ++i) {
    if (std::abs(residuals[i] - residuals[i - 1]) <= least) continue;
    const std::size_t begin = std::max(settled, i - std::min(i, kPhaseFrames));
    const std::size_t end = std::min(residuals.size(), i + kPhaseFrames);
    if (i - begin < kLeastPhaseFrames || end - i < kLeastPhaseFrames) continue;
    const double step = std::remainder(
        median_of_stretch(residuals, i, end) - median_of_stretch(residuals, begin, i),
        grid.period_ms);
    if (std::abs(step) <= least) continue;
    grid.steps.push_back({.frame = i, .step_ms = step});
    settled = i;
  }
}

}  // namespace

std::optional<StampGrid> stamp_grid(std::span<const StampedFrame> frames,
                                    std::optional<double> other_period_ms) {
  const std::vector<double> intervals = advancing_intervals(frames);
  if (intervals.empty()) return std::nullopt;
  StampGrid grid;
  grid.period_ms = grid_period_of(frames, intervals, other_period_ms);
  grid.points.assign(1, 0);
  grid.missing.assign(1, 0);
  if (on_grid_share(intervals, grid.period_ms) >= kFewOnGrid) {
    place_by_intervals(frames, grid);
  } else {
    constexpr double kTakenBack = -0.25;
    place_by_phase(frames, grid);
    grid.exists = correlation_of_intervals(frames, grid.period_ms) < kTakenBack;
    if (!grid.exists) grid.missing.assign(frames.size(), 0);
  }
  note_deviations(frames, grid);
  if (grid.exists) find_steps(frames, grid);
  return grid;
}

}  // namespace simbench::evaluation
