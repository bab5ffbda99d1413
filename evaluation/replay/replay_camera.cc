#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "algorithms/device_time/saturate.h"
#include "algorithms/device_time/unwrap.h"
#include "evaluation/replay/replay.h"
#include "evaluation/scoring/results.h"
#include "evaluation/statistics/statistics.h"

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

std::int64_t missing_frames(std::span<const StampedFrame> frames) {
  std::int64_t missing = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const std::uint64_t before = frames[i - 1].counter;
    const std::uint64_t now = frames[i].counter;
    // A counter that goes back was restarted; a leap beyond any recording is no gap.
    if (now > before && now - before < (std::uint64_t{1} << 32)) {
      missing += static_cast<std::int64_t>(now - before - 1);
    }
  }
  return missing;
}

// The point with the smallest residual in [begin, end).
std::size_t earliest(std::span<const double> residuals, std::size_t begin, std::size_t end) {
  const auto first = residuals.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = residuals.begin() + static_cast<std::ptrdiff_t>(end);
  return static_cast<std::size_t>(std::min_element(first, last) - residuals.begin());
}

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
  return {.mean_ms = mean_of(excess),
          .p50_ms = quantile(excess, 0.50),
          .p95_ms = quantile(excess, 0.95),
          .p99_ms = quantile(excess, 0.99),
          .max_ms = quantile(excess, 1)};
}

}  // namespace

double difference_ms(std::int64_t a_ns, std::int64_t b_ns) {
  return to_double(Int128{a_ns} - b_ns) * 1e-6;
}

ResidualStatistics residual_statistics(std::vector<double> values) {
  const double mean = mean_of(values);
  for (double& value : values) value -= mean;
  return {.sd_ms = standard_deviation(values),
          .p95_ms = quantile(values, 0.95),
          .p99_ms = quantile(values, 0.99),
          .max_ms = quantile(values, 1)};
}

Nanoseconds median_period(std::span<const StampedFrame> frames) {
  if (frames.size() < 2) return Nanoseconds::zero();
  return from_ms(median(intervals_ms(frames, &StampedFrame::sensor)));
}

std::vector<StampedFrame> unwrapped(std::span<const StampedFrame> frames) {
  std::vector<StampedFrame> result(frames.begin(), frames.end());
  const bool in_register = std::all_of(result.begin(), result.end(), [](const StampedFrame& f) {
    return f.sensor.count() < kDeviceRegisterNs;
  });
  if (!in_register) return result;
  CounterUnwrapper<kDeviceRegisterNs> unwrapper;
  for (StampedFrame& frame : result) {
    frame.sensor = Nanoseconds(unwrapper.unwrap(frame.sensor.count()));
  }
  return result;
}

CameraStatistics camera_statistics(std::span<const StampedFrame> frames) {
  CameraStatistics result;
  result.frames = static_cast<std::int64_t>(frames.size());
  if (frames.empty()) return result;
  result.missing_frames = missing_frames(frames);
  result.span_s =
      difference_ms(frames.back().arrival.count(), frames.front().arrival.count()) * 1e-3;

  const std::vector<double> sensor = intervals_ms(frames, &StampedFrame::sensor);
  result.sensor_period = period_statistics(sensor);
  result.arrival_period = period_statistics(intervals_ms(frames, &StampedFrame::arrival));
  const double longest = kLongInterval * median(sensor);
  for (const double interval : sensor) {
    if (interval > longest) ++result.long_intervals;
    if (interval < 0) ++result.backward_steps;
  }

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
