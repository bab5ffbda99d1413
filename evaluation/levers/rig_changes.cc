#include "evaluation/levers/rig_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "scenarios/camera_profile.h"
#include "scenarios/part.h"

namespace simbench::evaluation {
namespace {

using scenarios::Override;
using scenarios::Scenario;
using scenarios::SyncMode;

Override set(std::string pointer, double value) {
  return {std::move(pointer), fmt::format("{}", value)};
}

struct Member {
  std::string_view pointer;
  double value;
};
// Sets each member that is not 0 already to `factor` times its value.
std::vector<Override> scaled(const std::vector<Member>& members, double factor) {
  std::vector<Override> sets;
  for (const Member& each : members) {
    if (each.value > 0) sets.push_back(set(std::string(each.pointer), factor * each.value));
  }
  return sets;
}

void add(std::string what, std::vector<Override> sets, std::vector<RigChange>& changes) {
  if (!sets.empty()) changes.push_back({std::move(what), std::move(sets)});
}

void add_exposures(const Scenario& scenario, std::vector<RigChange>& changes) {
  const scenarios::Cameras& cameras = scenario.cameras;
  add("equal exposures (no auto-exposure)",
      scaled({{"/cameras/exposure_camera_periods", cameras.exposure_camera_periods},
              {"/cameras/exposure_host_periods", cameras.exposure_host_periods},
              {"/cameras/auto_exposure/step_interval_exponential_ms",
               cameras.auto_exposure.step_interval_exponential_ms}},
             0),
      changes);
  if (!cameras.groups.empty()) return;  // each may have an exposure of its own
  constexpr double kHalf = 0.5;
  add(fmt::format("exposures of {:.3g} ms in place of {:.3g} (half of the light)",
                  kHalf * cameras.exposure_ms, cameras.exposure_ms),
      scaled({{"/cameras/exposure_ms", cameras.exposure_ms}}, kHalf), changes);
}

void add_usb(const Scenario& scenario, std::vector<RigChange>& changes) {
  const scenarios::Usb& usb = scenario.usb;
  constexpr double kHalf = 0.5;
  if (usb.sharing != scenarios::UsbSharing::kDedicated && usb.cameras_per_controller > 1) {
    add("a USB controller for each camera", {{"/usb/cameras_per_controller", "1"}}, changes);
  }
  add("half of the jitter of USB delivery",
      scaled({{"/usb/kernel_copy_exponential_ms", usb.kernel_copy_exponential_ms},
              {"/usb/delivery_jitter_transfers", usb.delivery_jitter_transfers},
              {"/usb/host_jitter_transfers", usb.host_jitter_transfers},
              {"/usb/spike_probability", usb.spike_probability}},
             kHalf),
      changes);
  add("arrival stamps of nanoseconds",
      scaled({{"/hosts/clock/arrival_quantum_ms", scenario.hosts.clock.arrival_quantum_ms}}, 0),
      changes);
  const scenarios::ClockPoll& polls = scenario.cameras.clock_poll;
  if (!polls.is_on()) return;
  std::vector<Override> sets;
  if (polls.request_ms != polls.reply_ms) {
    const double each_ms = std::min(polls.request_ms, polls.reply_ms);
    sets = {set("/cameras/clock_poll/request_ms", each_ms),
            set("/cameras/clock_poll/reply_ms", each_ms)};
  }
  add("polls of the cameras' clocks that take as long there as back", std::move(sets), changes);
}

// What the cameras are in, for a trigger of the same rate.
void add_sync_modes(const Scenario& scenario, std::vector<RigChange>& changes) {
  if (!scenario.cameras.groups.empty()) return;  // models with modes of their own
  const scenarios::Stream* const scored = scenario.scored_stream();
  const scenarios::CameraProfile* const profile =
      scenarios::find_camera_profile(scenario.cameras.model);
  if (scored == nullptr || profile == nullptr || scenario.cameras.frame_control) return;
  const double rate_hz = scenario.trigger.rate_hz;
  const std::string mode_rate =
      fmt::format("/cameras/streams/{}/mode_rate_hz", scored - scenario.cameras.streams.data());
  const auto offer = [&](SyncMode mode, double mode_rate_hz, double rate_error_ppm) {
    if (scenario.cameras.sync_mode == mode || profile->sync_mode(mode) == nullptr) return;
    const std::string name(to_text(mode));
    add("cameras in the mode " + name,
        {{"/cameras/sync_mode", name},
         set(mode_rate, mode_rate_hz),
         set("/trigger/rate_error_ppm", rate_error_ppm)},
        changes);
  };
  offer(SyncMode::kGenlock, 2 * rate_hz, 0);
  constexpr double kFastForSlaves = 500;  // ppm, docs/reference/d455.md
  offer(SyncMode::kSlave, rate_hz, kFastForSlaves);
  offer(SyncMode::kFullSlave, rate_hz, kFastForSlaves);
}

void add_host_clocks(const Scenario& scenario, std::vector<RigChange>& changes) {
  if (scenario.hosts.count < 2) return;
  add("temperature-compensated oscillators (TCXO) in the hosts",
      {{"/hosts/clock/oscillator/class", "tcxo"}}, changes);
  for (const scenarios::Part& part : scenarios::parts()) {
    if (part.kind != scenarios::PartKind::kClock || part.sets.empty()) continue;
    changes.push_back({.what = fmt::format("{} ({})", part.part, part.name),
                       .sets = part.sets,
                       .host_sync = part.host_sync});
  }
}

}  // namespace

std::vector<RigChange> rig_changes(const Scenario& scenario) {
  std::vector<RigChange> changes;
  add_exposures(scenario, changes);
  add_usb(scenario, changes);
  add_sync_modes(scenario, changes);
  add_host_clocks(scenario, changes);
  return changes;
}

}  // namespace simbench::evaluation
