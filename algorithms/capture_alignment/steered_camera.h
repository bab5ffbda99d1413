// A camera under an algorithm of the stage: its frames with their exposures, its controls counted,
// and what is reported of it. And the algorithms that steer each camera on its own.
//
// Contract
//  - next_frame() waits for as long as it takes; a camera that stays silent is reported once.
//  - A control that is refused is reported as not aligned, with the reason; the call returns false,
//    and the algorithm should leave that camera alone.
//  - is_settled() is false for frames that may not show yet what the last control did: those within
//    latency_frames + 2 frames after it, by their number and by their exposure. A control that is
//    still not visible then was late or lost; the algorithm finds the error again and repeats it.
//  - report() forwards a report if it says something new; a mere count of controls at most once a
//    second.
//
//   Task<void> steer(Host& host, FrameControl& control) {
//     SteeredCamera camera(host, control);
//     while (true) {
//       const ExposedFrame frame = co_await camera.next_frame();
//       if (!camera.is_settled(frame)) continue;
//       const Nanoseconds late = phase_error(frame.exposed.time_since_epoch(), camera.length());
//       const bool is_taken = co_await camera.adjust_frame(-late);
//       if (!is_taken) co_return;
//     }
//   }
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/capture_alignment/frame_clock.h"
#include "algorithms/ports/capture_alignment.h"

namespace simbench {

class SteeredCamera {
 public:
  // A camera without a frame for so long is reported.
  static constexpr Nanoseconds kPatience = std::chrono::seconds(5);
  static constexpr Nanoseconds kReportInterval = std::chrono::seconds(1);

  // Both must outlive it.
  SteeredCamera(Host& host, FrameControl& camera);

  Host& host() { return host_; }
  const FrameControlLimits& limits() const { return camera_.limits(); }
  // That the camera's frames have by themselves, and the least and the most that it accepts.
  Nanoseconds length() const;
  Nanoseconds shortest() const;
  Nanoseconds longest() const;
  // Why no frame of it can follow a grid of that period, with what would help; empty if some can.
  std::string unreachable(Nanoseconds period) const;

  Task<ExposedFrame> next_frame();
  bool is_settled(const ExposedFrame& frame) const;

  Task<bool> adjust_frame(Nanoseconds by);
  Task<bool> insert_frame(Nanoseconds length);
  Task<bool> set_frame_length(Nanoseconds length);
  Task<bool> start_at(HostTime at);

  void report(bool aligned, std::string message = "");

 private:
  bool sent(const FrameControlReply& reply);

  Host& host_;
  FrameControl& camera_;
  FrameClock clock_;
  std::uint32_t newest_ = 0;  // number of the last frame that came
  std::uint32_t controls_ = 0;
  std::optional<SteadyTime> sent_;  // the last control
  std::uint32_t newest_when_sent_ = 0;
  std::optional<AlignmentReport> reported_;
  SteadyTime reported_at_{};
};

// `time` less the nearest multiple of `period`: from -period/2 to below period/2. period > 0.
Nanoseconds phase_error(Nanoseconds time, Nanoseconds period);

// An algorithm that steers each camera on its own by its host's system clock, without messages.
class EachCamera final : public CaptureAlignment {
 public:
  using Steer = std::function<Task<void>(Host& host, FrameControl& camera)>;
  explicit EachCamera(Steer steer) : steer_(std::move(steer)) {}
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  Steer steer_;
};

// What makes such an algorithm of its settings, for with_settings() (algorithms/registry.h):
// steer(host, camera, settings).
template <class Settings>
auto each_camera(Task<void> (*steer)(Host& host, FrameControl& camera, Settings settings)) {
  return [steer](const Settings& settings) {
    return std::make_unique<EachCamera>([steer, settings](Host& host, FrameControl& camera) {
      return steer(host, camera, settings);
    });
  };
}

}  // namespace simbench
