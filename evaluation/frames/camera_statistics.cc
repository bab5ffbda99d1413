#include "evaluation/frames/camera_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

#include "algorithms/device_time/unwrap.h"
#include "evaluation/frames/frame_account.h"
#include "evaluation/statistics/statistics.h"
#include "laws/saturate.h"
#include "recording/counted.h"

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

void note_intervals_of_camera(std::span<const StampedFrame> frames, CameraStatistics& result) {
  const std::vector<double> sensor = intervals_ms(frames, &StampedFrame::sensor);
  const double period_ms = median(sensor);
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

// `values`: in any order; their mean is subtracted first.
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

}  // namespace

double difference_ms(std::int64_t a_ns, std::int64_t b_ns) {
  return to_double(Int128{a_ns} - b_ns) * 1e-6;
}

Nanoseconds median_period(std::span<const StampedFrame> frames) {
  if (frames.size() < 2) return Nanoseconds::zero();
  return from_ms(median(intervals_ms(frames, &StampedFrame::sensor)));
}

std::vector<StampedFrame> unwrapped(std::span<const StampedFrame> recorded) {
  std::vector<StampedFrame> frames(recorded.begin(), recorded.end());
  const bool in_register = std::all_of(frames.begin(), frames.end(), [](const StampedFrame& f) {
    return f.sensor.count() < kDeviceRegisterNs;
  });
  if (!in_register) return frames;
  CounterUnwrapper<kDeviceRegisterNs> unwrapper;
  for (StampedFrame& frame : frames) {
    frame.sensor = Nanoseconds(unwrapper.unwrap(frame.sensor.count()));
  }
  return frames;
}

std::span<const StampedFrame> without_unsteady_start(std::span<const StampedFrame> frames) {
  const Nanoseconds begin = frames.front().arrival;
  if (frames.back().arrival - begin < kLongRecording) return frames;
  const auto first = std::ranges::find_if(
      frames, [begin](const StampedFrame& f) { return f.arrival - begin >= kUnsteadyStart; });
  return frames.subspan(static_cast<std::size_t>(first - frames.begin()));
}

std::int64_t put_in_order_of_exposure(std::vector<StampedFrame>& frames) {
  constexpr std::uint64_t kFarthest = 64;  // frames; more is a restart
  const auto overtaken = [&frames](std::size_t i, std::size_t before) {
    return frames[i].sensor < frames[before].sensor && frames[i].counter < frames[before].counter &&
           frames[before].counter - frames[i].counter <= kFarthest;
  };
  std::int64_t moved = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (!overtaken(i, i - 1) || frames[i].arrival < frames[i - 1].arrival) continue;
    std::size_t place = i - 1;
    while (place > 0 && overtaken(i, place - 1)) --place;
    const auto begin = frames.begin() + static_cast<std::ptrdiff_t>(place);
    const auto end = frames.begin() + static_cast<std::ptrdiff_t>(i);
    std::rotate(begin, end, end + 1);
    ++moved;
  }
  return moved;
}

bool counts_from_1970(std::span<const StampedFrame> frames) {
  constexpr Nanoseconds kYear2000 = std::chrono::seconds(946'684'800);
  return std::any_of(frames.begin(), frames.end(),
                     [kYear2000](const StampedFrame& frame) { return frame.sensor >= kYear2000; });
}

bool has_one_clock(std::span<const StampedFrame> frames) {
  return frames.size() > 1 && std::ranges::all_of(frames, [](const StampedFrame& frame) {
           return frame.sensor == frame.arrival;
         });
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

StampStatistics stamp_statistics(std::span<const StampedFrame> frames,
                                 std::span<const GlobalTime> stamps, bool relative) {
  StampStatistics found{.jitter_ms = kNan, .residual = {kNan, kNan, kNan, kNan}, .drift_ppm = kNan};
  if (frames.empty()) return found;
  std::vector<double> sensor(frames.size());
  std::vector<double> offset(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    sensor[i] = difference_ms(frames[i].sensor.count(), frames[0].sensor.count());
    offset[i] = difference_ms(nanoseconds_of(stamps[i]), nanoseconds_of(stamps[0])) - sensor[i];
  }
  if (!relative) found.drift_ppm = fit_line(sensor, offset).slope * 1e6;
  for (std::size_t i = frames.size(); i-- > 1;) offset[i] -= offset[i - 1];
  found.jitter_ms = standard_deviation(std::span(offset).subspan(1));
  if (relative) return found;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    offset[i] = difference_ms(frames[i].arrival.count(), nanoseconds_of(stamps[i]));
  }
  found.residual = residual_statistics(std::move(offset));
  return found;
}

std::vector<std::string> doubts_of(const RecordedStream& stream) {
  const std::vector<StampedFrame> frames = unwrapped(stream.frames);
  const CameraStatistics found = camera_statistics(frames);
  const FrameAccount account = frame_account(frames, stream.counted);
  std::vector<std::string> doubts;
  const auto add = [&](const std::string& text) {
    doubts.push_back(fmt::format("{} {}: {}", stream.camera, stream.stream, text));
  };
  if (found.backward_steps > 0) {
    add(fmt::format("sensor stamps go back {}: frames were reordered, or the camera was restarted",
                    times(found.backward_steps)));
  }
  if (found.backward_arrivals > 0) {
    add(
        fmt::format("arrivals go back {}: the host's clock was set back, or the file was put "
                    "together from several; drift, periods and delays may be wrong",
                    times(found.backward_arrivals)));
  }
  if (account.counter_jumps > 0) {
    add(
        fmt::format("the frame counter jumps {} by more frames than the time between two allows "
                    "(by {} at most); these are not counted as lost",
                    times(account.counter_jumps), account.largest_jump));
  }
  if (account.counter_restarts > 0 && found.backward_steps == 0) {
    add(
        fmt::format("the frame counter stands still or goes back {}: the camera was restarted, or "
                    "frames arrived twice; lost frames may be more",
                    times(account.counter_restarts)));
  }
  if (has_one_clock(stream.frames)) {
    add("arrivals and sensor stamps are the same, as from one column of a file: there is one clock "
        "only, and drift, residual and excess say nothing");
  } else if (counts_from_1970(frames) && stream.realsense) {
    add("sensor stamps count from 1970: with librealsense's global time they are the host's own "
        "estimate, and drift, jitter and residual are those of the estimate. Record with global "
        "time off");
  } else if (is_doubtful_drift(found.drift_ppm)) {
    add(
        fmt::format("a drift of {:.0f} ppm is no camera's, whose clock is right to some tens of "
                    "ppm: are both stamps milliseconds of one camera, and are {} enough?",
                    found.drift_ppm, counted(static_cast<std::uint64_t>(found.frames), "frame")));
  }
  if (found.frames < 2) add("has one frame: too few for a drift or a jitter");
  return doubts;
}

}  // namespace simbench::evaluation
