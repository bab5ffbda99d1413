#include "evaluation/frames/frame_account.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "evaluation/frames/camera_statistics.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kLongestPausePeriods = 1000;  // a longer gap is a pause, or a clock that was set
constexpr std::size_t kLongestPeriodSpan = 30;

double sensor_interval_ms(const StampedFrame& before, const StampedFrame& now) {
  return difference_ms(now.sensor.count(), before.sensor.count());
}

// Whether a counter that went up by `step` counted frames: no more than fit twice into the time
// between, and some. More is a jump.
bool is_counter_gap(std::uint64_t step, const StampedFrame& before, const StampedFrame& now,
                    std::optional<double> period_ms) {
  constexpr double kMargin = 10;
  if (step >= std::uint64_t{1} << 32) return false;
  if (!period_ms) return true;
  const double arrival = difference_ms(now.arrival.count(), before.arrival.count());
  const double passed_ms = std::max(std::abs(sensor_interval_ms(before, now)), std::abs(arrival));
  return static_cast<double>(step) <= kMargin + 2 * passed_ms / *period_ms;
}

// The periods between two frames that have no frame, by the camera's clock.
std::int64_t missing_periods(const StampedFrame& before, const StampedFrame& now,
                             std::optional<double> period_ms) {
  if (!period_ms) return 0;
  const double periods = std::round(sensor_interval_ms(before, now) / *period_ms);
  if (!(periods > 1) || periods > kLongestPausePeriods) return 0;
  return std::llround(periods) - 1;
}

FrameGap gap_between(const StampedFrame& before, const StampedFrame& now, bool counted,
                     std::optional<double> period_ms) {
  const std::int64_t missing = missing_periods(before, now, period_ms);
  if (!counted) return {.unknown = missing};
  if (now.counter <= before.counter) return {.unknown = missing, .counter_restarts = true};
  const std::uint64_t step = now.counter - before.counter;
  if (!is_counter_gap(step, before, now, period_ms)) {
    return {.unknown = missing, .counter_jump = step};
  }
  const auto lost = static_cast<std::int64_t>(step - 1);
  return {.lost = lost, .never_exposed = std::max<std::int64_t>(0, missing - lost)};
}

}  // namespace

std::optional<double> stream_period_ms(std::span<const StampedFrame> frames) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double interval = sensor_interval_ms(frames[i - 1], frames[i]);
    if (interval > 0) intervals.push_back(interval);
  }
  if (intervals.empty()) return std::nullopt;
  const double interval = median(std::move(intervals));
  const std::size_t span = std::min<std::size_t>(kLongestPeriodSpan, frames.size() / 4);
  if (span < 2) return interval;
  std::vector<double> periods(1);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    periods.push_back(periods.back() +
                      std::round(sensor_interval_ms(frames[i - 1], frames[i]) / interval));
  }
  std::vector<double> means;
  for (std::size_t i = span; i < frames.size(); ++i) {
    const double count = periods[i] - periods[i - span];
    const double length = sensor_interval_ms(frames[i - span], frames[i]);
    if (count > 0 && length > 0) means.push_back(length / count);
  }
  return means.empty() ? interval : median(std::move(means));
}

std::vector<FrameGap> frame_gaps(std::span<const StampedFrame> frames, bool counted) {
  const std::optional<double> period_ms = stream_period_ms(frames);
  std::vector<FrameGap> gaps;
  gaps.reserve(frames.size());
  for (std::size_t i = 1; i < frames.size(); ++i) {
    gaps.push_back(gap_between(frames[i - 1], frames[i], counted, period_ms));
  }
  return gaps;
}

FrameAccount frame_account(std::span<const StampedFrame> frames, bool counted) {
  FrameAccount account{.delivered = static_cast<std::int64_t>(frames.size())};
  for (const FrameGap& gap : frame_gaps(frames, counted)) {
    account.lost += gap.lost;
    account.never_exposed += gap.never_exposed;
    account.unknown += gap.unknown;
    if (gap.counter_restarts) ++account.counter_restarts;
    if (gap.counter_jump > 0) ++account.counter_jumps;
    account.largest_jump = std::max(account.largest_jump, gap.counter_jump);
  }
  return account;
}

FrameAccount frame_account(const RecordedStream& stream) {
  return frame_account(unwrapped(stream.frames), stream.counted);
}

}  // namespace simbench::evaluation
