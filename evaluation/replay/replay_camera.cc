#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "algorithms/device_time/unwrap.h"
#include "evaluation/replay/replay.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"
#include "laws/saturate.h"

namespace simbench::evaluation {
namespace {

constexpr double kLongInterval = 1.5;

using Stamp = Nanoseconds StampedFrame::*;

std::vector<double> intervals_ms(std::span<const StampedFrame> frames, Stamp stamp) {
  std::vector<double> intervals;
  intervals.reserve(frames.size());
  for (std::size_t i = 1; i < frames.size(); ++i) {
    intervals.push_back(difference_ms((frames[i].*stamp).count(), (frames[i - 1].*stamp).count()));
  }
  return intervals;
}

PeriodStatistics period_statistics(std::span<const double> intervals) {
  return {mean_of(intervals), standard_deviation(intervals)};
}

void note_counters(std::span<const StampedFrame> frames, double period_ms,
                   CameraStatistics& result) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const std::uint64_t before = frames[i - 1].counter;
    const std::uint64_t now = frames[i].counter;
    if (now <= before) {
      ++result.counter_restarts;
    } else if (is_counter_gap(now - before, frames[i - 1], frames[i], period_ms)) {
      result.missing_frames += static_cast<std::int64_t>(now - before - 1);
    } else {
      ++result.counter_jumps;
      result.largest_jump = std::max(result.largest_jump, now - before);
    }
  }
}

void note_intervals_of_camera(std::span<const StampedFrame> frames, CameraStatistics& result) {
  const std::vector<double> sensor = intervals_ms(frames, &StampedFrame::sensor);
  const double period_ms = median(sensor);
  note_counters(frames, period_ms, result);
  result.sensor_period = period_statistics(sensor);
  for (const double interval : sensor) {
    if (interval > kLongInterval * period_ms) ++result.long_intervals;
    if (interval < 0) ++result.backward_steps;
  }
  const std::vector<double> arrival = intervals_ms(frames, &StampedFrame::arrival);
  result.arrival_period = period_statistics(arrival);
  result.backward_arrivals =
      std::count_if(arrival.begin(), arrival.end(), [](double interval) { return interval < 0; });
}

// The point with the smallest residual in [begin, end).
std::size_t earliest(std::span<const double> residuals, std::size_t begin, std::size_t end) {
  const auto first = residuals.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = residuals.begin() + static_cast<std::ptrdiff_t>(end);
  return static_cast<std::size_t>(std::min_element(first, last) - residuals.begin());
}

// Quantiles of one sample, in ascending order: each is selected above the one before.
class UpperQuantiles {
 public:
  explicit UpperQuantiles(std::vector<double> values) : values_(std::move(values)) {}

  double next(double p) {
    if (values_.empty()) return kNan;
    const auto begin = values_.begin() + sorted_;
    const auto below =
        values_.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(values_.size() - 1) * p);
    if (below >= begin) {
      std::nth_element(begin, below, values_.end());
      sorted_ = below - values_.begin() + 1;
    }
    const auto above = below + 1;
    if (above != values_.end() && above - values_.begin() >= sorted_) {
      std::iter_swap(above, std::min_element(above, values_.end()));
      sorted_ = above - values_.begin() + 1;
    }
    return quantile_of_sorted(values_, p);
  }

 private:
  std::vector<double> values_;
  std::ptrdiff_t sorted_ = 0;  // so many, or the last two of them, are in their places
};

// The line through the earliest frames of the first and of the last tenth.
FittedLine envelope_line(std::span<const double> x, std::span<const double> y,
                         std::span<const double> residuals) {
  const std::size_t tenth = std::max<std::size_t>(1, x.size() / 10);
  const std::size_t a = earliest(residuals, 0, tenth);
  const std::size_t b = earliest(residuals, x.size() - tenth, x.size());
  const double slope = x[a] == x[b] ? kNan : (y[b] - y[a]) / (x[b] - x[a]);
  return {.slope = slope, .mean_x = x[a], .mean_y = y[a]};
}

ExcessStatistics excess_statistics(std::span<const double> x, std::span<const double> y,
                                   const FittedLine& envelope) {
  std::vector<double> excess(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) excess[i] = y[i] - envelope.at(x[i]);
  const double lowest = *std::min_element(excess.begin(), excess.end());
  for (double& value : excess) value -= lowest;
  const double mean = mean_of(excess);
  UpperQuantiles quantiles(std::move(excess));
  return {.mean_ms = mean,
          .p50_ms = quantiles.next(0.50),
          .p95_ms = quantiles.next(0.95),
          .p99_ms = quantiles.next(0.99),
          .max_ms = quantiles.next(1)};
}

}  // namespace

double difference_ms(std::int64_t a_ns, std::int64_t b_ns) {
  return to_double(Int128{a_ns} - b_ns) * 1e-6;
}

ResidualStatistics residual_statistics(std::vector<double> values) {
  const double mean = mean_of(values);
  for (double& value : values) value -= mean;
  const double deviation = standard_deviation(values);
  UpperQuantiles quantiles(std::move(values));
  return {.sd_ms = deviation,
          .p95_ms = quantiles.next(0.95),
          .p99_ms = quantiles.next(0.99),
          .max_ms = quantiles.next(1)};
}

Nanoseconds median_period(std::span<const StampedFrame> frames) {
  if (frames.size() < 2) return Nanoseconds::zero();
  return from_ms(median(intervals_ms(frames, &StampedFrame::sensor)));
}

void unwrap(std::vector<StampedFrame>& frames) {
  const bool in_register = std::all_of(frames.begin(), frames.end(), [](const StampedFrame& f) {
    return f.sensor.count() < kDeviceRegisterNs;
  });
  if (!in_register) return;
  CounterUnwrapper<kDeviceRegisterNs> unwrapper;
  for (StampedFrame& frame : frames) {
    frame.sensor = Nanoseconds(unwrapper.unwrap(frame.sensor.count()));
  }
}

std::vector<StampedFrame> unwrapped(std::span<const StampedFrame> frames) {
  std::vector<StampedFrame> result(frames.begin(), frames.end());
  unwrap(result);
  return result;
}

bool is_counter_gap(std::uint64_t step, const StampedFrame& before, const StampedFrame& now,
                    double period_ms) {
  constexpr double kMargin = 10;
  if (step >= std::uint64_t{1} << 32) return false;
  if (!(period_ms > 0)) return true;
  const double sensor = difference_ms(now.sensor.count(), before.sensor.count());
  const double arrival = difference_ms(now.arrival.count(), before.arrival.count());
  const double passed_ms = std::max(std::abs(sensor), std::abs(arrival));
  return static_cast<double>(step) <= kMargin + 2 * passed_ms / period_ms;
}

bool counts_from_1970(std::span<const StampedFrame> frames) {
  constexpr Nanoseconds kYear2000 = std::chrono::seconds(946'684'800);
  return std::any_of(frames.begin(), frames.end(),
                     [kYear2000](const StampedFrame& frame) { return frame.sensor >= kYear2000; });
}

bool is_doubtful_drift(double ppm) {
  constexpr double kLargestPpm = 10'000;
  return std::abs(ppm) > kLargestPpm;
}

CameraStatistics camera_statistics(std::span<const StampedFrame> frames) {
  CameraStatistics result;
  result.frames = static_cast<std::int64_t>(frames.size());
  if (frames.empty()) return result;
  result.span_s =
      difference_ms(frames.back().arrival.count(), frames.front().arrival.count()) * 1e-3;

  note_intervals_of_camera(frames, result);

  // y is arrival minus sensor: its slope is the small difference of the rates, not nearly 1.
  std::vector<double> x(frames.size());
  std::vector<double> y(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    x[i] = difference_ms(frames[i].sensor.count(), frames[0].sensor.count());
    y[i] = difference_ms(frames[i].arrival.count(), frames[0].arrival.count()) - x[i];
  }
  const FittedLine line = fit_line(x, y);
  result.drift_ppm = line.slope * 1e6;
  std::vector<double> residuals(frames.size());
  for (std::size_t i = 0; i < x.size(); ++i) residuals[i] = y[i] - line.at(x[i]);
  const FittedLine envelope = envelope_line(x, y, residuals);
  result.envelope_drift_ppm = envelope.slope * 1e6;
  result.excess = excess_statistics(x, y, envelope);
  result.residual = residual_statistics(std::move(residuals));
  return result;
}

}  // namespace simbench::evaluation
