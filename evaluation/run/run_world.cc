#include "evaluation/run/run_world.h"

#include <algorithm>
#include <utility>

namespace simbench::evaluation {
namespace {

constexpr Nanoseconds kClockInterval = std::chrono::milliseconds(20);
constexpr std::uint64_t kLongestGap = 10'000;  // frames; a longer one is a counter that began anew
constexpr std::int64_t kMostClockSamplesOfAService = 2000;  // before the capture

// What is missing between one delivered frame and the next.
std::vector<LostFrame> gaps(const RunDetail& run) {
  std::vector<LostFrame> lost;
  for (std::uint32_t camera = 0; camera < run.cameras.size(); ++camera) {
    const std::vector<FrameDetail>& frames = run.cameras[camera].frames;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      const std::uint64_t next = frames[i - 1].counter + std::uint64_t{1};
      if (frames[i].counter > next + kLongestGap) continue;
      for (std::uint64_t counter = next; counter < frames[i].counter; ++counter) {
        lost.push_back({.camera = camera, .counter = static_cast<std::uint32_t>(counter)});
      }
    }
  }
  return lost;
}

}  // namespace

ClockErrors clock_errors(TrueTime at, std::span<const Nanoseconds> errors) {
  ClockErrors clocks{.at_ms = to_ms(at.time_since_epoch()), .errors_ms = {}};
  for (const Nanoseconds error : errors.first(std::min(errors.size(), kDetailCameras))) {
    clocks.errors_ms.push_back(to_ms(error));
  }
  return clocks;
}

RunWorld::RunWorld(StreamKind stream, std::int64_t hosts, std::optional<Nanoseconds> service)
    : stream_(stream),
      service_(service.has_value()),
      clock_interval_(
          std::max(kClockInterval * (1 + hosts / static_cast<std::int64_t>(kDetailCameras)),
                   service.value_or(Nanoseconds::zero()) / kMostClockSamplesOfAService)) {}

void RunWorld::on_world(TrueTime start) { start_ = start; }
void RunWorld::on_capture_start(TrueTime at) { capture_start_ = at; }
void RunWorld::on_pulse(const ObservedPulse&) {}
void RunWorld::on_message(const ObservedMessage&) {}

void RunWorld::on_frame(const ObservedFrame& frame) {
  if (frame.fate == FrameFate::kDelivered || frame.stream != stream_) return;
  if (frame.camera >= kDetailCameras) return;
  lost_.push_back({.camera = frame.camera,
                   .counter = frame.counter,
                   .pulse = frame.pulse,
                   .fate = frame.fate,
                   .mid_exposure_ms = (to_ms(frame.exposure_start.time_since_epoch()) +
                                       to_ms(frame.exposure_end.time_since_epoch())) /
                                      2});
}

void RunWorld::on_clocks(TrueTime at, std::span<const Nanoseconds> errors) {
  clocks_.push_back(clock_errors(at, errors));
}

void RunWorld::add_to(RunDetail& run, double wait_before_capture_ms) {
  run.service = service_;
  run.lost = start_ ? std::move(lost_) : gaps(run);
  run.clocks.insert(run.clocks.end(), clocks_.begin(), clocks_.end());
  std::stable_sort(run.clocks.begin(), run.clocks.end(),
                   [](const ClockErrors& a, const ClockErrors& b) { return a.at_ms < b.at_ms; });
  if (start_) run.world_start_ms = to_ms(start_->time_since_epoch());
  if (!capture_start_) return;
  run.capture_start_ms = to_ms(capture_start_->time_since_epoch());
  if (!service_) run.sync_end_ms = run.capture_start_ms - wait_before_capture_ms;
}

}  // namespace simbench::evaluation
