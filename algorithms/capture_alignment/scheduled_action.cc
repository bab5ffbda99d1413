// One start at a time of the common clock, as a Scheduled Action Command of GigE Vision 2.0 gives
// it: all cameras begin to expose then, and run free afterwards.
//
// Each host takes the next whole second of its own disciplined clock and `lead_s` more, so that no
// message is needed. Hosts that ask on different sides of a second start a second apart: the same
// phase wherever whole frames fill a second. `repeat_s` later, if it is not 0, the cameras start
// again, which takes out what their oscillators have drifted.
//
// The first start is asked for once the camera runs. A start that was lost leaves the exposures
// where they were. The first start is therefore repeated where they did not move by more than
// `moved_us`, three times in all; a camera that happened to be in phase is then reported as not
// aligned.

#include <string>
#include <vector>

#include "algorithms/capture_alignment/steered_camera.h"
#include "algorithms/registry.h"

namespace simbench {
namespace {

const char* const kScheduledAction =
    "docs.baslerweb.com, Scheduled Action Commands (GigE Vision 2.0)";
constexpr int kStartAttempts = 3;
constexpr std::uint32_t kFramesAfterStart = 4;  // more than a stamp by arrivals is late

struct ScheduledActionSettings {
  Nanoseconds lead = from_seconds(1);
  Nanoseconds repeat{0};  // 0: never
  Nanoseconds moved = from_us(100);

  void bind(ParameterBinder& parameters) {
    parameters.number("lead_s", lead, 0, 1e6, "from the next whole second to the start",
                      kAssumption);
    parameters.number("repeat_s", repeat, 0, 1e6, "from one start to asking for the next; 0: never",
                      kAssumption);
    parameters.number("moved_us", moved, 0, 1e6, "a start that moves the exposures less was lost",
                      kAssumption);
  }
};

Task<bool> start_at_next_second(SteeredCamera& camera, Nanoseconds lead) {
  const HostTime now = co_await camera.host().clock().now();
  const std::int64_t second = floor_div(nanoseconds_of(now), kSecondNs) + 1;
  const HostTime at = HostTime(Nanoseconds(second * kSecondNs)) + lead;
  const bool is_taken = co_await camera.start_at(at);
  co_return is_taken;
}

// By how much the start that has just been moved the phase of the exposures.
Task<Nanoseconds> phase_step(SteeredCamera& camera) {
  const SteadyTime start = camera.host().steady_clock().now();
  ExposedFrame before = co_await camera.next_frame();
  while (true) {
    const ExposedFrame frame = co_await camera.next_frame();
    if (frame.exposed_steady < start) before = frame;
    if (frame.exposed_steady < start + kFramesAfterStart * camera.length()) continue;
    co_return phase_error(frame.exposed_steady - before.exposed_steady, camera.length());
  }
}

Task<void> start_on_schedule(Host& host, FrameControl& control, ScheduledActionSettings settings) {
  SteeredCamera camera(host, control);
  if (camera.limits().allows(FrameControlKind::kStartAt)) co_await camera.next_frame();
  bool is_aligned = false;
  for (int attempt = 0; attempt < kStartAttempts && !is_aligned; ++attempt) {
    const bool is_taken = co_await start_at_next_second(camera, settings.lead);
    if (!camera.limits().allows(FrameControlKind::kStartAt)) co_return;
    if (!is_taken) continue;
    const Nanoseconds step = co_await phase_step(camera);
    is_aligned = std::chrono::abs(step) > settings.moved;
  }
  const std::string unmoved = "its exposures did not move at " + std::to_string(kStartAttempts) +
                              " starts; do the commands reach it?";
  camera.report(is_aligned, is_aligned ? "" : unmoved);
  while (settings.repeat.count() > 0) {
    co_await host.sleep_for(settings.repeat);
    const bool is_taken = co_await start_at_next_second(camera, settings.lead);
    if (is_taken) camera.report(true);
  }
}

}  // namespace

std::vector<CaptureAlignmentEntry> capture_alignment_scheduled_action() {
  return {with_settings<CaptureAlignmentEntry>(
      {.name = "scheduled_action",
       .family = "scheduled_action",
       .summary = "all cameras start at one time of the common clock, then run free",
       .source = kScheduledAction,
       .needs = {Need::kFrameControl}},
      ScheduledActionSettings{}, each_camera(start_on_schedule))};
}

}  // namespace simbench
