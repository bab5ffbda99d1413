#include "evaluation/diagnosis/rate_changes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "evaluation/frames/camera_statistics.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

using Frames = std::span<const StampedFrame>;

constexpr double kSameInterval = 0.1;  // of the middle one
constexpr double kMostOfBlock = 0.8;
constexpr std::size_t kFineBlocks = 8;
constexpr std::size_t kFewestOfBlock = 60;  // frames
constexpr double kFineSigmas = 6;
constexpr std::size_t kFewestBlocks = 2;

double stamp_interval_ms(Frames frames, std::size_t from, std::size_t to) {
  return difference_ms(frames[to].sensor.count(), frames[from].sensor.count());
}

double seconds_at(Frames frames, std::size_t i) {
  return difference_ms(frames[i].arrival.count(), frames.front().arrival.count()) * 1e-3;
}

// The interval that most of a block's frames have; NaN if they have none in common.
double block_interval_ms(Frames frames, std::size_t begin) {
  std::vector<double> intervals;
  for (std::size_t i = begin + 1; i <= begin + kRateFrames; ++i) {
    intervals.push_back(stamp_interval_ms(frames, i - 1, i));
  }
  const double middle = median(intervals);
  const auto same = std::ranges::count_if(intervals, [middle](double interval) {
    return std::abs(interval - middle) < kSameInterval * middle;
  });
  const bool most = static_cast<double>(same) >= kMostOfBlock * static_cast<double>(kRateFrames);
  return middle > 0 && most ? middle : kNan;
}

// False if one of them is NaN.
bool is_same_rate(double a_ms, double b_ms) { return std::abs(a_ms / b_ms - 1) < kCoarseShare; }

// Two blocks of another rate in succession.
std::vector<RateChange> coarse_changes(Frames frames) {
  std::vector<RateChange> changes;
  double now = kNan;
  double next = kNan;  // of the block before, if it had another rate
  std::size_t since = 0;
  for (std::size_t begin = 0; begin + kRateFrames < frames.size(); begin += kRateFrames) {
    const double found = block_interval_ms(frames, begin);
    if (std::isnan(found)) continue;
    if (std::isnan(now)) now = found;
    if (is_same_rate(found, next) && !is_same_rate(found, now)) {
      changes.push_back(
          {.at_s = seconds_at(frames, since), .from_hz = 1e3 / now, .to_hz = 1e3 / found});
      now = found;
    }
    const bool same = is_same_rate(found, now);
    next = same ? kNan : found;
    if (!same) since = begin;
  }
  return changes;
}

// The grid's period within [begin, end), by a line; moves of the phase within it spoil it.
double block_period_ms(Frames frames, const StampGrid& grid, std::size_t begin, std::size_t end) {
  std::vector<double> points;
  std::vector<double> lateness;
  for (std::size_t i = begin; i < end; ++i) {
    points.push_back(static_cast<double>(grid.points[i] - grid.points[begin]));
    lateness.push_back(stamp_interval_ms(frames, begin, i) - points.back() * grid.period_ms);
  }
  return grid.period_ms + fit_line(points, lateness).slope;
}

bool has_step(const StampGrid& grid, std::size_t begin, std::size_t end) {
  return std::ranges::any_of(
      grid.steps, [&](const GridStep& step) { return step.frame >= begin && step.frame < end; });
}

// The standard deviation of values about their mean; 0 for a few that are one.
double spread_of_periods(std::span<const double> values) {
  return values.size() < 2 ? 0 : standard_deviation(values);
}

// One change between two levels that each hold for some blocks.
std::vector<RateChange> fine_changes(Frames frames, const StampGrid& grid) {
  const std::size_t size = frames.size() / kFineBlocks;
  if (size < kFewestOfBlock) return {};
  std::vector<double> periods;
  std::vector<std::size_t> begins;
  for (std::size_t begin = 0; begin + size <= frames.size(); begin += size) {
    if (has_step(grid, begin, begin + size)) continue;
    periods.push_back(block_period_ms(frames, grid, begin, begin + size));
    begins.push_back(begin);
  }
  double best = 0;
  std::vector<RateChange> found;
  for (std::size_t at = kFewestBlocks; at + kFewestBlocks <= periods.size(); ++at) {
    const std::span<const double> before(periods.data(), at);
    const std::span<const double> after(periods.data() + at, periods.size() - at);
    const double moved = std::abs(mean_of(after) - mean_of(before));
    const double spread = std::max(spread_of_periods(before), spread_of_periods(after));
    if (moved < kFineShare * grid.period_ms || moved < kFineSigmas * spread || moved < best)
      continue;
    best = moved;
    found = {{.at_s = seconds_at(frames, begins[at]),
              .from_hz = 1e3 / mean_of(before),
              .to_hz = 1e3 / mean_of(after)}};
  }
  return found;
}

}  // namespace

std::vector<RateChange> rate_changes(std::span<const StampedFrame> frames, const StampGrid& grid) {
  std::vector<RateChange> changes = coarse_changes(frames);
  return changes.empty() ? fine_changes(frames, grid) : changes;
}

}  // namespace simbench::evaluation
