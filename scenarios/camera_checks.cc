#include "scenarios/camera_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/camera_groups.h"
#include "scenarios/camera_profile.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"
#include "scenarios/pulse_window.h"
#include "scenarios/scenario_json.h"

namespace simbench::scenarios {
namespace {

void check_profile(const Scenario& scenario, const CameraProfile& camera,
                   const std::string& pointer, const Stream& stream) {
  const StreamProfile* profile = camera.stream(stream.kind);
  if (profile == nullptr) {
    std::vector<std::string_view> kinds;
    for (const StreamProfile& each : camera.streams) kinds.push_back(to_text(each.kind));
    fail_at(scenario, pointer + "/kind",
            fmt::format("found {}, allowed {} (streams of the {})", to_text(stream.kind),
                        fmt::join(kinds, ", "), camera.name));
  }
  const ImageSize* offered = profile->find_size(stream.width, stream.height);
  if (offered == nullptr) {
    std::vector<std::string> sizes;
    for (const ImageSize& size : profile->sizes) {
      sizes.push_back(fmt::format("{}x{}", size.width, size.height));
    }
    fail_at(scenario, pointer + "/width",
            fmt::format("found {} {}x{}, allowed {} (profiles of the {})", to_text(stream.kind),
                        stream.width, stream.height, fmt::join(sizes, ", "), camera.name));
  }
  const std::vector<double>& rates = offered->rates_hz;
  if (std::find(rates.begin(), rates.end(), stream.mode_rate_hz) == rates.end()) {
    fail_at(scenario, pointer + "/mode_rate_hz",
            fmt::format("found {}, allowed {} (profiles of the {} for {} {}x{})",
                        stream.mode_rate_hz, fmt::join(rates, ", "), camera.name,
                        to_text(stream.kind), stream.width, stream.height));
  }
}

std::vector<std::string_view> modes_of(const CameraProfile& camera) {
  std::vector<std::string_view> modes;
  for (const SyncModeProfile& each : camera.sync_modes) modes.push_back(to_text(each.mode));
  return modes;
}

void check_sync_mode(const Scenario& scenario, const CameraProfile& camera) {
  const SyncMode mode = scenario.cameras.sync_mode;
  if (camera.sync_mode(mode) != nullptr) return;
  fail_at(scenario, "/cameras/sync_mode",
          fmt::format("found \"{}\", allowed \"{}\" (sync modes of the {})", to_text(mode),
                      fmt::join(modes_of(camera), "\", \""), camera.name));
}

// `pointer` is of the object that states the model.
const CameraProfile& checked_profile(const Scenario& scenario, const std::string& pointer) {
  const std::string& model = scenario.cameras.model;
  if (const CameraProfile* camera = find_camera_profile(model)) return *camera;
  std::vector<std::string> models;
  for (const CameraProfile& each : camera_profiles()) models.push_back(each.model);
  fail_at(scenario, pointer + "/model",
          fmt::format("found \"{}\", allowed {} (simbench list cameras)", shown_text(model),
                      fmt::join(models, ", ")));
}

// What helps against pulses that a mode is too slow for: a mode of that size that the pulses are
// near, else a slower trigger; genlock where the camera has it.
std::string help_against_fast_pulses(const CameraProfile& camera, const Stream& stream,
                                     double rate_hz) {
  std::vector<double> rates;
  for (const double offered :
       camera.stream(stream.kind)->find_size(stream.width, stream.height)->rates_hz) {
    const PulseWindow window(offered);
    if (!window.is_slower(rate_hz) && !window.is_faster(rate_hz)) rates.push_back(offered);
  }
  std::string help = rates.empty()
                         ? fmt::format("no mode of {}x{} is as fast", stream.width, stream.height)
                         : fmt::format("a mode of {} Hz would follow", fmt::join(rates, " or "));
  if (camera.sync_mode(SyncMode::kGenlock) != nullptr) {
    help += ", and genlock answers a part of any pulses";
  }
  return help;
}

// Slaves follow pulses close to their mode rate; what they do with faster ones is not documented
// (docs/reference/d455.md section 2). An evaluated stream that runs free keeps its mode rate, which
// must then be the evaluated rate.
void check_full_rate(const Scenario& scenario, const CameraProfile& camera,
                     const std::string& pointer, const Stream& stream) {
  const std::vector<double>& rates = camera.sync_rates_hz;
  const SyncMode mode = scenario.cameras.sync_mode;
  if (mode != SyncMode::kDefault && !rates.empty() &&
      std::find(rates.begin(), rates.end(), stream.mode_rate_hz) == rates.end()) {
    fail_at(scenario, pointer + "/mode_rate_hz",
            fmt::format("found {}, allowed {} in sync mode \"{}\"", stream.mode_rate_hz,
                        fmt::join(rates, ", "), to_text(mode)));
  }
  const bool follows_trigger = scenario.cameras.follows_trigger(stream);
  if (!follows_trigger && stream.kind != scenario.evaluation.stream) return;
  const double rate = scenario.trigger.pulse_rate_hz();
  const PulseWindow window(stream.mode_rate_hz);
  const bool is_faster = window.is_faster(rate);
  const bool may_be_slower = follows_trigger && scenario.cameras.begins_at_pulse();
  if (!is_faster && (may_be_slower || !window.is_slower(rate))) return;
  fail_at(
      scenario, "/trigger/rate_hz",
      fmt::format("found {:.6g} Hz, allowed {:.6g} to {:.6g} Hz in sync mode \"{}\" with a {} "
                  "Hz mode{}",
                  rate, window.slowest_hz, window.fastest_hz, to_text(mode), stream.mode_rate_hz,
                  follows_trigger && is_faster
                      ? ": what a slave does with faster pulses is not documented; " +
                            help_against_fast_pulses(camera, stream, rate)
                      : ""));
}

// The model and its sync mode, the sizes and rates of the streams.
void check_rates(const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const CameraProfile& camera = checked_profile(scenario, "/cameras");
  check_sync_mode(scenario, camera);
  for (std::size_t i = 0; i < cameras.streams.size(); ++i) {
    const Stream& stream = cameras.streams[i];
    const std::string pointer = fmt::format("/cameras/streams/{}", i);
    check_profile(scenario, camera, pointer, stream);
    if (cameras.sync_mode != SyncMode::kGenlock) {
      check_full_rate(scenario, camera, pointer, stream);
    }
  }
}

// What a rig with groups may not have: code that knows cameras of one kind alone.
void check_what_groups_exclude(const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  if (cameras.streams.size() != 1) {
    fail_at(scenario, "/cameras/streams",
            fmt::format("found {} streams, allowed 1 with /cameras/groups, which state in what "
                        "that one differs",
                        cameras.streams.size()));
  }
  if (cameras.frame_control) {
    fail_at(scenario, "/cameras/frame_control",
            "found controls, allowed null with /cameras/groups: cameras that are steered are of "
            "one model");
  }
  if (cameras.streams.front().calibrated_delay_ms) {
    fail_at(scenario, "/cameras/streams/0/calibrated_delay_ms",
            fmt::format("found {}, allowed null with /cameras/groups: a delay is measured of one "
                        "model, and null is computed for each group",
                        *cameras.streams.front().calibrated_delay_ms));
  }
  if (scenario.studio) {
    fail_at(scenario, "/studio",
            "found a studio, allowed null with /cameras/groups: its cameras have one focal length");
  }
}

void check_counts(const Scenario& scenario) {
  std::int64_t together = 0;
  for (const CameraGroup& group : scenario.cameras.groups) together += group.count;
  if (together == scenario.cameras.count) return;
  fail_at(scenario, "/cameras/groups",
          fmt::format("found groups of {} cameras together, allowed {} (/cameras/count)", together,
                      scenario.cameras.count));
}

// Some pulses must be exposed by all cameras.
void check_common_pulses(const Scenario& scenario) {
  std::int64_t together = 1;
  const std::vector<CameraGroup>& groups = scenario.cameras.groups;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    together = std::lcm(together, groups[group].pulses_per_frame);
    if (together <= scenario.timeline.frames) continue;
    fail_at(scenario, fmt::format("/cameras/groups/{}/pulses_per_frame", group),
            fmt::format("found {}, with which all cameras expose at one pulse in {}, allowed at "
                        "least one of the {} pulses of /timeline/frames",
                        groups[group].pulses_per_frame, together, scenario.timeline.frames));
  }
}

// Controllers are filled in the order of a host's cameras, as sim/rig/cameras.h has them.
void check_controllers(const Scenario& scenario) {
  const std::vector<std::size_t> groups = group_of_cameras(scenario.cameras);
  const auto per_controller = static_cast<std::size_t>(scenario.usb.cameras_per_controller);
  std::vector<std::size_t> cameras_on_host(static_cast<std::size_t>(scenario.hosts.count));
  std::vector<std::size_t> first_on_controller(cameras_on_host.size());
  for (std::size_t camera = 0; camera < groups.size(); ++camera) {
    const auto host = static_cast<std::size_t>(scenario.host_of(static_cast<std::int64_t>(camera)));
    std::size_t& first = first_on_controller[host];
    if (cameras_on_host[host]++ % per_controller == 0) first = camera;
    if (groups[first] == groups[camera]) continue;
    fail_at(scenario, "/usb/cameras_per_controller",
            fmt::format("found {}, by which camera {} of group {} is on the controller of camera "
                        "{} of group {}, allowed controllers of one group: 1 makes them so",
                        per_controller, camera, groups[camera], first, groups[first]));
  }
}

// The pulses that the cameras of a group get, in the mode of their stream.
void check_rate_of_group(const Scenario& alone, std::int64_t pulses_per_frame,
                         const std::string& pointer) {
  const Stream& stream = alone.cameras.streams.front();
  const bool follows = alone.cameras.follows_trigger(stream);
  if (!follows && pulses_per_frame > 1) {
    fail_at(alone, pointer + "/pulses_per_frame",
            fmt::format("found {}, allowed 1: in sync mode \"{}\" the {} stream gets no pulses",
                        pulses_per_frame, to_text(alone.cameras.sync_mode), to_text(stream.kind)));
  }
  const double rate_hz = alone.trigger.pulse_rate_hz();
  const PulseWindow window(stream.mode_rate_hz);
  const bool begins_at_pulse = follows && alone.cameras.begins_at_pulse();
  const bool is_genlock = alone.cameras.sync_mode == SyncMode::kGenlock;
  const bool is_faster =
      is_genlock ? alone.pulses_per_frame(stream) > 1 : window.is_faster(rate_hz);
  if (!is_faster && (begins_at_pulse || !window.is_slower(rate_hz))) return;
  fail_at(
      alone, pointer + "/mode_rate_hz",
      fmt::format("found {}, which does not answer each of {:.6g} pulses a second (one in {} of "
                  "/trigger/rate_hz), allowed {}; a pulses_per_frame of the group changes the "
                  "pulses that it gets",
                  stream.mode_rate_hz, rate_hz, pulses_per_frame,
                  is_genlock        ? "at least twice that rate"
                  : begins_at_pulse ? "at least that rate"
                                    : "that rate"));
}

void check_shutter(const Scenario& scenario, const Stream& stream, const CameraProfile& camera,
                   const std::string& pointer) {
  const bool is_rolling = stream.shutter == ShutterKind::kRolling;
  if (is_rolling == (stream.readout_ms > 0)) return;
  fail_at(scenario, pointer + "/readout_ms",
          fmt::format("found {}, allowed {}: the {} has a {} shutter", stream.readout_ms,
                      is_rolling ? "more than 0" : "0", camera.name, to_text(stream.shutter)));
}

void check_sync_mode_of_group(const Scenario& alone, const CameraProfile& camera,
                              const std::string& pointer) {
  const SyncMode mode = alone.cameras.sync_mode;
  if (camera.sync_mode(mode) != nullptr) return;
  fail_at(alone, pointer + "/model",
          fmt::format("found \"{}\", which has no sync mode \"{}\" (/cameras/sync_mode), allowed "
                      "\"{}\" with it: all groups have one sync mode",
                      camera.model, to_text(mode), fmt::join(modes_of(camera), "\", \"")));
}

void check_groups(const Scenario& scenario) {
  if (scenario.cameras.groups.empty()) return;
  check_what_groups_exclude(scenario);
  check_counts(scenario);
  check_common_pulses(scenario);
  check_controllers(scenario);
  for (std::size_t group = 0; group < scenario.cameras.groups.size(); ++group) {
    const std::string pointer = fmt::format("/cameras/groups/{}", group);
    const Scenario alone = group_alone(scenario, group);
    const Stream& stream = alone.cameras.streams.front();
    const CameraProfile& camera = checked_profile(alone, pointer);
    check_sync_mode_of_group(alone, camera, pointer);
    check_profile(alone, camera, pointer, stream);
    check_rate_of_group(alone, pulses_per_frame(scenario.cameras, group), pointer);
    if (alone.cameras.sync_mode != SyncMode::kGenlock) {
      check_full_rate(alone, camera, pointer, stream);
    }
    check_shutter(alone, stream, camera, pointer);
    const bool follows = scenario.cameras.follows_trigger(scenario.cameras.streams.front());
    if (alone.cameras.follows_trigger(stream) == follows) continue;
    fail_at(scenario, pointer + "/model",
            fmt::format("found \"{}\", whose {} stream {} the trigger in sync mode \"{}\", and "
                        "that of /cameras/model {}; allowed models that do alike",
                        alone.cameras.model, to_text(stream.kind),
                        follows ? "does not follow" : "follows",
                        to_text(scenario.cameras.sync_mode), follows ? "does" : "does not"));
  }
}

}  // namespace

void check_camera_models(const Scenario& scenario) {
  check_rates(scenario);
  check_groups(scenario);
}

}  // namespace simbench::scenarios
