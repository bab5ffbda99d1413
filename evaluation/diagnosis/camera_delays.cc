#include "evaluation/diagnosis/camera_delays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "evaluation/frames/camera_statistics.h"

namespace simbench::evaluation {
namespace {

constexpr std::size_t kFewestDelays = 30;
constexpr double kLikeRates = 0.05;
constexpr double kNoisesOfJump = 10;  // of a jump
constexpr double kLeastJumpMs = 0.5;
constexpr std::size_t kMostBeside = 15;  // frames on either side of a jump
constexpr std::size_t kLeastBeside = 5;
constexpr double kBusyS = 5;      // a delay that is undone sooner is lateness
constexpr double kUndone = 0.25;  // of the jump: what may remain of it

std::vector<double> successive_differences(std::span<const double> values) {
  std::vector<double> found;
  for (std::size_t i = 1; i < values.size(); ++i) found.push_back(values[i] - values[i - 1]);
  return found;
}

double median_between(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  return median(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                    values.begin() + static_cast<std::ptrdiff_t>(end)));
}

// A jump up that the next one takes back soon.
void drop_busy_times(std::vector<DelayJump>& jumps) {
  for (std::size_t i = 0; i + 1 < jumps.size();) {
    const DelayJump& up = jumps[i];
    const DelayJump& down = jumps[i + 1];
    const bool passes = up.step_ms > 0 && std::abs(down.at_s - up.at_s) < kBusyS &&
                        std::abs(up.step_ms + down.step_ms) < kUndone * up.step_ms;
    const auto at = jumps.begin() + static_cast<std::ptrdiff_t>(i);
    if (passes) {
      jumps.erase(at, at + 2);
    } else {
      ++i;
    }
  }
}

}  // namespace

std::optional<CameraDelays> camera_delays(const RecordedStream& stream) {
  if (stream.frames.size() < kFewestDelays || has_one_clock(stream.frames)) return std::nullopt;
  const std::vector<StampedFrame> all = unwrapped(stream.frames);
  CameraDelays found{.camera = stream.camera,
                     .host = stream.host,
                     .stream = stream.stream,
                     .stamped_by_host = stream.stamped_by_host,
                     .left_out = 0};
  const std::span<const StampedFrame> frames = without_unsteady_start(all);
  found.left_out = all.size() - frames.size();
  if (frames.size() < kFewestDelays) return std::nullopt;
  if (counts_from_1970(frames)) found.stamp_ms = to_ms(frames.front().sensor);
  std::vector<double> arrival_ms;
  for (const StampedFrame& frame : frames) {
    found.arrival_s.push_back(to_seconds(frame.arrival));
    found.sensor_ms.push_back(difference_ms(frame.sensor.count(), frames.front().sensor.count()));
    arrival_ms.push_back(difference_ms(frame.arrival.count(), frames.front().arrival.count()));
    found.delay_ms.push_back(arrival_ms.back() - found.sensor_ms.back());
  }
  found.period_ms = median(successive_differences(arrival_ms));
  const double sensor_period_ms = median(successive_differences(found.sensor_ms));
  const bool is_alike = std::abs(sensor_period_ms / found.period_ms - 1) < kLikeRates;
  if (!(found.period_ms > 0) || !is_alike) return std::nullopt;
  found.noise_ms = robust_deviation(successive_differences(found.delay_ms)) / std::numbers::sqrt2;
  return found;
}

double smallest_jump_ms(const CameraDelays& delays) {
  return std::max(kLeastJumpMs, kNoisesOfJump * delays.noise_ms);
}

std::vector<DelayJump> delay_jumps(const CameraDelays& delays) {
  const std::vector<double>& delay_ms = delays.delay_ms;
  const double least_ms = smallest_jump_ms(delays);
  std::vector<DelayJump> jumps;
  std::size_t settled = 0;  // no jump before this frame
  for (std::size_t i = 1; i < delay_ms.size(); ++i) {
    const std::size_t before = std::min(kMostBeside, i - settled);
    const std::size_t after = std::min(kMostBeside, delay_ms.size() - i);
    if (before < kLeastBeside || after < kLeastBeside) continue;
    if (std::abs(delay_ms[i] - delay_ms[i - 1]) <= least_ms / 2) continue;
    const double step_ms =
        median_between(delay_ms, i, i + after) - median_between(delay_ms, i - before, i);
    if (std::abs(step_ms) <= least_ms) continue;
    jumps.push_back({.at_s = delays.arrival_s[i - 1], .step_ms = step_ms});
    settled = i;
  }
  drop_busy_times(jumps);
  return jumps;
}

}  // namespace simbench::evaluation
