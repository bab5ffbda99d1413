#include "evaluation/frames/frame_account.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "evaluation/frames/camera_statistics.h"

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kLongestPausePeriods = 1000;  // a longer gap is a pause, or a clock was set

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

FrameGap gap_between(const StampedFrame& before, const StampedFrame& now, bool counted,
                     std::optional<double> period_ms, std::int64_t missing) {
  if (missing >= kLongestPausePeriods) missing = 0;
  if (!counted) return {.unknown = missing};
  if (now.counter <= before.counter) return {.unknown = missing, .counter_restarts = true};
  const std::uint64_t step = now.counter - before.counter;
  if (!is_counter_gap(step, before, now, period_ms)) {
    return {.unknown = missing, .counter_jump = step};
  }
  const auto lost = static_cast<std::int64_t>(step - 1);
  return {.lost = lost, .never_exposed = std::max<std::int64_t>(0, missing - lost)};
}

std::vector<FrameGap> gaps_on(const std::optional<StampGrid>& grid,
                              std::span<const StampedFrame> frames, bool counted) {
  std::optional<double> period_ms;
  if (grid) period_ms = grid->period_ms;
  std::vector<FrameGap> gaps;
  gaps.reserve(frames.size());
  for (std::size_t i = 1; i < frames.size(); ++i) {
    gaps.push_back(
        gap_between(frames[i - 1], frames[i], counted, period_ms, grid ? grid->missing[i] : 0));
  }
  return gaps;
}

FrameAccount account_of(const std::vector<FrameGap>& gaps, std::size_t frames) {
  FrameAccount account{.delivered = static_cast<std::int64_t>(frames)};
  for (const FrameGap& gap : gaps) {
    account.lost += gap.lost;
    account.never_exposed += gap.never_exposed;
    account.unknown += gap.unknown;
    if (gap.counter_restarts) ++account.counter_restarts;
    if (gap.counter_jump > 0) ++account.counter_jumps;
    account.largest_jump = std::max(account.largest_jump, gap.counter_jump);
  }
  return account;
}

}  // namespace

std::vector<FrameGap> frame_gaps(std::span<const StampedFrame> frames, bool counted) {
  return gaps_on(stamp_grid(frames), frames, counted);
}

std::vector<FrameGap> frame_gaps(std::span<const StampedFrame> frames, bool counted,
                                 const StampGrid& grid) {
  return gaps_on(grid, frames, counted);
}

FrameAccount frame_account(std::span<const StampedFrame> frames, bool counted) {
  return account_of(frame_gaps(frames, counted), frames.size());
}

FrameAccount frame_account(std::span<const StampedFrame> frames, bool counted,
                           const StampGrid& grid) {
  return account_of(frame_gaps(frames, counted, grid), frames.size());
}

FrameAccount frame_account(const RecordedStream& stream) {
  std::vector<StampedFrame> frames = unwrapped(stream.frames);
  put_in_order_of_exposure(frames);
  return frame_account(frames, stream.counted);
}

}  // namespace simbench::evaluation
