#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/builtin_files.h"
#include "scenarios/camera_groups.h"
#include "scenarios/camera_profile.h"
#include "scenarios/frequency_limit.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

struct Warning {
  std::string pointer;
  std::string text;
  bool loses_pulses = false;  // this world loses pulses by it
};
using Lines = std::vector<Warning>;

void warn(Lines& lines, const std::string& pointer, const std::string& text) {
  lines.push_back({.pointer = pointer, .text = text});
}

void warn_of_loss(Lines& lines, const std::string& pointer, const std::string& text) {
  lines.push_back({.pointer = pointer, .text = text, .loses_pulses = true});
}

// The bytes that a camera sends, in 1e6 per second.
double camera_load_mb_per_s(const Scenario& scenario) {
  double load = 0;
  for (const Stream& stream : scenario.cameras.streams) {
    load += stream.image_bytes() * scenario.frame_rate_hz(stream) * 1e-6;
  }
  return load;
}

std::int64_t most_cameras_on_a_host(const Scenario& scenario) {
  const std::vector<std::size_t> counts = scenario.cameras_by_host();
  return static_cast<std::int64_t>(*std::max_element(counts.begin(), counts.end()));
}

// More cameras are reported to lose frames (docs/reference/d455.md section 3).
constexpr std::int64_t kKnownToWork = 3;

// The rate at which the triggered streams of a camera must be transferred while they are read out,
// all at once; 0: whenever the controller is free.
double readout_mb_per_s(const Scenario& scenario) {
  if (scenario.usb.hold_mode_periods == 0) return 0;
  double rate = 0;
  for (const Stream& stream : scenario.cameras.streams) {
    if (!scenario.cameras.follows_trigger(stream)) continue;
    rate += stream.image_bytes() * stream.mode_rate_hz * 1e-6 / scenario.usb.hold_mode_periods;
  }
  return rate;
}

std::string cameras_text(std::int64_t count) {
  return count == 1 ? "1 camera" : fmt::format("{} cameras", count);
}

void warn_about_shared_usb(Lines& lines, const Scenario& scenario, std::int64_t cameras) {
  const double carried = scenario.usb.bandwidth_mb_per_s;
  const double needed = camera_load_mb_per_s(scenario) * static_cast<double>(cameras);
  const double at_once = readout_mb_per_s(scenario) * static_cast<double>(cameras);
  const std::string need = fmt::format("{} on a controller {} {:.1f} MB/s", cameras_text(cameras),
                                       cameras == 1 ? "needs" : "need", std::max(needed, at_once));
  if (at_once > std::max(carried, needed)) {
    warn_of_loss(
        lines, "/usb/bandwidth_mb_per_s",
        fmt::format("{} while the frames of a pulse are read out (the rates of their modes; {:.1f} "
                    "MB/s on average), and it carries {:g}: expect at least {:.1f} % of these "
                    "frames to arrive incomplete, which the SDK discards "
                    "(/usb/hold_mode_periods)",
                    need, needed, carried, 100 * (1 - carried / at_once)));
  } else if (needed > carried) {
    warn_of_loss(
        lines, "/usb/bandwidth_mb_per_s",
        fmt::format("{}, and it carries {:g}: expect at least {:.1f} % of the frames to be lost",
                    need, carried, 100 * (1 - carried / needed)));
  } else if (cameras > kKnownToWork) {
    warn(lines, "/usb/cameras_per_controller",
         fmt::format("{} of the {:g} that it carries, so none is lost on it here; real "
                     "controllers with more than {} are reported to lose some "
                     "(docs/reference/d455.md section 3)",
                     need, carried, kKnownToWork));
  }
}

// Whether somebody other than the distribution has said this: by --set, or in a file that is no
// copy of a built-in scenario, as archives have them.
bool is_stated(const Scenario& scenario, const std::string& pointer) {
  if (std::ranges::count(scenario.derivation.changes, pointer, &Change::pointer) > 0) return true;
  if (scenario.origin->is_set(pointer)) return true;
  return std::ranges::count(builtin_files(), scenario.name, &BuiltinFile::name) == 0 &&
         scenario.origin->is_of_a_users_file(pointer);
}

// Where each camera has the whole bandwidth, no number of cameras is too many.
void warn_about_dedicated_usb(Lines& lines, const Scenario& scenario) {
  constexpr const char* kPointer = "/usb/cameras_per_controller";
  const std::int64_t stated = scenario.usb.cameras_per_controller;
  const bool is_count_stated = stated > 1 && is_stated(scenario, kPointer);
  const bool is_sharing_stated = stated > 1 && is_stated(scenario, "/usb/sharing");
  const std::int64_t most = most_cameras_on_a_host(scenario);
  if (!is_count_stated && !is_sharing_stated && most <= kKnownToWork) return;
  const std::string what =
      is_count_stated || is_sharing_stated
          ? fmt::format("{} (found {}, allowed 1, which is what that means)", kPointer, stated)
          : fmt::format("that {} are on a host", cameras_text(most));
  warn(lines, is_count_stated ? kPointer : "/usb/sharing",
       fmt::format("each camera has {:g} MB/s of its own (/usb/sharing is \"dedicated\"), so "
                   "{} changes nothing: \"fair\" and \"fifo\" share a controller",
                   scenario.usb.bandwidth_mb_per_s, what));
}

// What paced and random traffic asks of each host's own port and of the port to it. TCP takes what
// is left.
void warn_about_traffic(Lines& lines, const Scenario& scenario) {
  const Network& network = scenario.network;
  const auto hosts = static_cast<std::size_t>(scenario.hosts.count);
  std::vector<double> sent(hosts);
  std::vector<double> received(hosts);
  for (const Traffic& traffic : network.traffic) {
    const double mbit_per_s = traffic.mbit_per_s.value_or(0);
    const auto from = static_cast<std::size_t>(traffic.from);
    const auto to = static_cast<std::size_t>(traffic.to);
    sent[from] += mbit_per_s;
    received[to] += mbit_per_s;
    if (!traffic.both_ways) continue;
    sent[to] += mbit_per_s;
    received[from] += mbit_per_s;
  }
  const auto warn_of_port = [&](double asked, const std::string& port) {
    const double carried = network.bandwidth_mbit_per_s;
    if (asked <= carried) return;
    warn(lines, "/network/traffic",
         fmt::format("{:g} Mbit/s are sent {}, which carries {:g}: {:.1f} % of them are lost, and "
                     "of the messages beside them",
                     asked, port, carried, 100 * (1 - carried / asked)));
  };
  for (std::size_t host = 0; host < hosts; ++host) {
    warn_of_port(sent[host], fmt::format("through host {}'s own port", host));
    warn_of_port(received[host], fmt::format("through the switch's port to host {}", host));
  }
}

void warn_about_usb(Lines& lines, const Scenario& scenario) {
  const Usb& usb = scenario.usb;
  if (usb.sharing == UsbSharing::kDedicated) {
    warn_about_shared_usb(lines, scenario, 1);
    warn_about_dedicated_usb(lines, scenario);
  } else {
    warn_about_shared_usb(lines, scenario,
                          std::min(usb.cameras_per_controller, most_cameras_on_a_host(scenario)));
  }
}

// The program that takes the frames: what it has no time for, and what it does not pass on.
void warn_about_reader(Lines& lines, const Scenario& scenario) {
  if (!scenario.hosts.frame_reader) return;
  const FrameReader& reader = *scenario.hosts.frame_reader;
  for (const Stream& stream : scenario.cameras.streams) {
    const double period_ms = 1e3 / scenario.frame_rate_hz(stream);
    if (reader.frame_ms <= period_ms) continue;
    warn_of_loss(
        lines, "/hosts/frame_reader/frame_ms",
        fmt::format("the program is busy with a frame of {} for {:g} ms and gets one each {:.4g} "
                    "ms: {} wait, then {:.3g} % are lost; allowed at most {:.4g} ms, or fewer "
                    "frames/s",
                    to_text(stream.kind), reader.frame_ms, period_ms, reader.queue_frames,
                    100 * (1 - period_ms / reader.frame_ms), period_ms));
  }
  if (reader.passed_every == 1) return;
  warn(lines, "/hosts/frame_reader/passed_every",
       fmt::format("the program passes on one frame in {} by its own count, which a lost frame "
                   "shifts against the other cameras'{}",
                   reader.passed_every,
                   scenario.cameras.common_start
                       ? ""
                       : "; cameras that start at different pulses pass on different ones"));
}

// Pulses that come too fast for genlock in the mode of a stream, which never expose it.
void warn_about_pulses(Lines& lines, const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const double rate = scenario.trigger.pulse_rate_hz();
  if (cameras.sync_mode != SyncMode::kGenlock) return;
  for (const Stream& stream : cameras.streams) {
    if (!cameras.follows_trigger(stream)) continue;
    const std::int64_t pulses = scenario.pulses_per_frame(stream);
    if (pulses == 1) continue;
    warn_of_loss(
        lines, "/trigger/rate_hz",
        fmt::format("genlock in a {} Hz mode ignores pulses for two mode periods less the guard of "
                    "{:g}, and so follows at most {:.6g} Hz: of {:.6g} Hz it answers one pulse in "
                    "{}, {:.6g} frames/s of {} (librealsense #12560){}",
                    stream.mode_rate_hz, cameras.genlock_guard_fraction,
                    scenario.fastest_pulses_hz(stream), rate, pulses,
                    scenario.frame_rate_hz(stream), to_text(stream.kind),
                    !cameras.common_start
                        ? "; cameras that start at different pulses expose at different ones"
                        : ""));
  }
}

// Exposures that do not end before the next pulse make the camera miss it.
void warn_about_exposure(Lines& lines, const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const double readout_ms =
      std::ranges::max_element(cameras.streams, {}, &Stream::readout_ms)->readout_ms;
  const auto triggered = std::ranges::find_if(
      cameras.streams, [&](const Stream& stream) { return cameras.follows_trigger(stream); });
  const bool is_triggered = triggered != cameras.streams.end();
  const double pulse_period_ms = 1e3 / scenario.trigger.pulse_rate_hz();
  const double period_ms =
      is_triggered ? 1e3 / scenario.frame_rate_hz(*triggered) : pulse_period_ms;
  const double start_ms = is_triggered ? cameras.trigger_to_exposure_us * 1e-3 : 0;
  const auto warn_if_longer = [&](const std::string& pointer, double longest_ms) {
    if (start_ms + longest_ms <= period_ms) return;
    warn_of_loss(
        lines, pointer,
        fmt::format("exposures of up to {:.2f} ms, beginning {:.2f} ms after the pulse, do not fit "
                    "into the frame period of {:.2f} ms: expect missed pulses and half the rate "
                    "(realsense-ros #2612)",
                    longest_ms, start_ms, period_ms));
  };
  warn_if_longer(
      "/cameras/exposure_ms",
      readout_ms + cameras.exposure_ms +
          (cameras.exposure_camera_periods + cameras.exposure_host_periods) * pulse_period_ms);
  if (cameras.auto_exposure.is_on()) {
    warn_if_longer("/cameras/auto_exposure/max_ms", readout_ms + cameras.auto_exposure.max_ms);
  }
}

void warn_about_shutters(Lines& lines, const Scenario& scenario) {
  const CameraProfile* camera = find_camera_profile(scenario.cameras.model);
  for (std::size_t i = 0; i < scenario.cameras.streams.size(); ++i) {
    const Stream& stream = scenario.cameras.streams[i];
    const StreamProfile* profile = camera->stream(stream.kind);
    if (stream.shutter == profile->shutter) continue;
    warn(lines, fmt::format("/cameras/streams/{}/shutter", i),
         fmt::format("{}, but the {} camera of the {} has a {} shutter", to_text(stream.shutter),
                     to_text(stream.kind), camera->name, to_text(profile->shutter)));
  }
}

// What the busiest host's cameras send, in 1e6 bytes per second.
double busiest_host_mb_per_s(const Scenario& scenario) {
  std::vector<double> load(static_cast<std::size_t>(scenario.hosts.count));
  for (std::size_t group = 0; group < group_count(scenario.cameras); ++group) {
    const Scenario alone = group_alone(scenario, group);
    const std::vector<std::size_t> counts = alone.cameras_by_host();
    for (std::size_t host = 0; host < counts.size(); ++host) {
      load[host] += camera_load_mb_per_s(alone) * static_cast<double>(counts[host]);
    }
  }
  return *std::ranges::max_element(load);
}

// Capture traffic through the port of the busiest host.
void warn_about_capture_traffic(Lines& lines, const Scenario& scenario) {
  const Network& network = scenario.network;
  if (network.bandwidth_mbit_per_s == 0) return;
  const double offered_mbit_per_s =
      busiest_host_mb_per_s(scenario) * 8 * network.capture_traffic_share;
  if (offered_mbit_per_s <= network.bandwidth_mbit_per_s) return;
  warn(lines, "/network/capture_traffic_share",
       fmt::format("the frames of a host are {:.0f} Mbit/s on a link that carries {:g}: what "
                   "finds more than a second of traffic queued is lost",
                   offered_mbit_per_s, network.bandwidth_mbit_per_s));
}

void warn_about_evaluation(Lines& lines, const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const Stream& stream = *scenario.scored_stream();
  if (!cameras.follows_trigger(stream) && !cameras.frame_control) {
    warn(lines, "/evaluation/stream",
         fmt::format("in sync mode \"{}\" the {} stream does not follow the trigger: its frames "
                     "differ by up to a frame period",
                     to_text(cameras.sync_mode), to_text(stream.kind)));
  }
  if (scenario.timeline.warm_up_ms < cameras.unstable_start_ms) {
    warn(lines, "/timeline/warm_up_ms",
         fmt::format("evaluation begins after {:g} ms, exposures are unsteady for {:g} ms",
                     scenario.timeline.warm_up_ms, cameras.unstable_start_ms));
  }
}

// Draws of the asymmetry that would leave one direction of a link less than nothing.
void warn_about_wires(Lines& lines, const Scenario& scenario) {
  const Network& network = scenario.network;
  const double least_ms = network.latency_quantiles_ms.empty()
                              ? network.latency_fixed_ms
                              : network.latency_quantiles_ms.front();
  const double sigma_ms =
      std::hypot(network.asymmetry_sigma_ms, std::numbers::sqrt2 * network.port_asymmetry_sigma_ms);
  if (sigma_ms == 0 || sigma_ms <= least_ms) return;
  warn(lines,
       network.asymmetry_sigma_ms >= network.port_asymmetry_sigma_ms
           ? "/network/asymmetry_sigma_ms"
           : "/network/port_asymmetry_sigma_ms",
       fmt::format("links differ by {:.3g} ms between their directions (one sigma) around a least "
                   "latency of {:.3g} ms: one link in twenty would be faster than light, and stops "
                   "at 0",
                   sigma_ms, least_ms));
}

void warn_about_wifi(Lines& lines, const Scenario& scenario) {
  if (!scenario.network.wifi || !scenario.hosts.nic.hardware_stamps) return;
  warn(lines, "/network/wifi",
       "a card's transmit stamp is of the instant at which it has the message, not of its "
       "transmission: hardware stamps see the wait for the channel as asymmetry");
}

// Controls that the scenario gives to a camera whose maker does not offer them.
void warn_about_controls(Lines& lines, const Scenario& scenario) {
  const CameraProfile& camera = *find_camera_profile(scenario.cameras.model);
  if (!scenario.cameras.frame_control || !camera.frame_control) return;
  const FrameControlModel& given = *scenario.cameras.frame_control;
  const FrameControlProfile& offered = *camera.frame_control;
  const auto warn_if_hypothetical = [&](const char* control, bool is_given, bool is_offered) {
    if (!is_given || is_offered) return;
    warn(lines, fmt::format("/cameras/frame_control/{}", control),
         fmt::format("a hypothetical control: no {} offers it (simbench list cameras)",
                     camera.name));
  };
  warn_if_hypothetical("adjust_frame", given.adjust_frame, offered.adjust_frame);
  warn_if_hypothetical("insert_frame", given.insert_frame, offered.insert_frame);
  warn_if_hypothetical("frame_length", given.frame_length, offered.frame_length);
  warn_if_hypothetical("start_at", given.start_at, offered.start_at);
}

void warn_about_temperature(Lines& lines, const Scenario& scenario) {
  if (!scenario.hosts.temperature) return;
  if (scenario.hosts.clock.oscillator.temperature_coefficient_ppb_per_k != 0) return;
  warn(lines, "/hosts/temperature",
       "changes nothing: /hosts/clock/oscillator/temperature_coefficient_ppb_per_k is 0 or not "
       "stated");
}

// Beside cameras that are hosts themselves, the master may be a computer without one.
void warn_about_idle_hosts(Lines& lines, const Scenario& scenario) {
  const std::vector<std::size_t> counts = scenario.cameras_by_host();
  const bool is_master_left_out = scenario.cameras.stamp_clock == ClockOwner::kHost;
  const std::int64_t idle =
      std::count(counts.begin() + (is_master_left_out ? 1 : 0), counts.end(), 0U);
  if (idle == 0) return;
  warn(lines, "/hosts/count",
       fmt::format("{} of {} hosts have no camera", idle, scenario.hosts.count));
}

// Walks and ramps that may get to the frequency error at which they end. The walk's sigma grows
// with the root of time; with half the limit one in ten gets there.
void warn_about_oscillators(Lines& lines, const Scenario& scenario) {
  const Timeline& timeline = scenario.timeline;
  const double seconds = (timeline.wait_before_capture_ms + timeline.warm_up_ms) * 1e-3 +
                         static_cast<double>(timeline.frames) / scenario.trigger.pulse_rate_hz();
  const auto warn_if_far = [&](const std::string& pointer, const char* what, double fraction,
                               double most) {
    if (fraction < most) return;
    warn(lines, pointer,
         fmt::format("{} the frequency by {:.2g} % in the {:.0f} s until the capture ends; it goes "
                     "no further than {:g} %",
                     what, 100 * fraction, seconds, 100 * kMostFrequencyError));
  };
  for (const auto& [oscillator, pointer] :
       {std::pair(&scenario.hosts.clock.oscillator, "/hosts/clock/oscillator"),
        std::pair(&scenario.cameras.oscillator, "/cameras/oscillator")}) {
    warn_if_far(fmt::format("{}/random_walk_ppb_per_sqrt_s", pointer), "the walk's sigma moves",
                oscillator->random_walk_ppb_per_sqrt_s * 1e-9 * std::sqrt(seconds),
                kMostFrequencyError / 2);
    warn_if_far(fmt::format("{}/ramp_ppm_per_hour", pointer), "the ramp moves",
                std::abs(oscillator->ramp_ppm_per_hour) * 1e-6 * seconds / 3600,
                kMostFrequencyError);
  }
}

// The distances of the nearest and the farthest camera from the point that all look at.
struct Sight {
  double nearest_m = 0;
  double farthest_m = 0;
};

Sight sight_of(const Studio& studio) {
  Sight sight = {.nearest_m = HUGE_VAL, .farthest_m = 0};
  for (const double height_m : studio.heights_m) {
    const double distance_m = std::hypot(studio.radius_m, height_m - studio.look_at_height_m);
    sight.nearest_m = std::min(sight.nearest_m, distance_m);
    sight.farthest_m = std::max(sight.farthest_m, distance_m);
  }
  return sight;
}

void warn_about_studio(Lines& lines, const Scenario& scenario) {
  if (!scenario.studio) return;
  const Studio& studio = *scenario.studio;
  const Sight sight = sight_of(studio);
  if (sight.nearest_m < studio.min_distance_m || sight.farthest_m > studio.max_distance_m) {
    warn(lines, "/studio/radius_m",
         fmt::format("cameras are {:.3g} to {:.3g} m from the centre they look at and see from "
                     "{:g} to {:g} m",
                     sight.nearest_m, sight.farthest_m, studio.min_distance_m,
                     studio.max_distance_m));
  }
  const StudioSubject& subject = studio.subject;
  if (subject.motion == MotionScript::kWalkAndTurn && subject.turn_rate_rad_per_s > 0) {
    const double circle_m = subject.walk_speed_m_per_s / subject.turn_rate_rad_per_s;
    if (circle_m >= studio.radius_m) {
      warn(lines, "/studio/subject/walk_speed_m_per_s",
           fmt::format("the subject walks on a circle of {:.3g} m, the cameras stand on one of "
                       "{:g} m",
                       circle_m, studio.radius_m));
    }
  }
}

// What may cost frames, of each group of cameras.
void warn_about_frames(Lines& lines, const Scenario& scenario) {
  for (std::size_t group = 0; group < group_count(scenario.cameras); ++group) {
    const Scenario alone = group_alone(scenario, group);
    Lines own;
    warn_about_usb(own, alone);
    warn_about_reader(own, alone);
    warn_about_pulses(own, alone);
    warn_about_exposure(own, alone);
    for (Warning& warning : own) {
      if (!scenario.cameras.groups.empty()) {
        warning.text = fmt::format("group {} of /cameras/groups: {}", group, warning.text);
      }
      lines.push_back(std::move(warning));
    }
  }
}

Lines all_warnings(const Scenario& scenario) {
  Lines lines;
  warn_about_frames(lines, scenario);
  warn_about_traffic(lines, scenario);
  warn_about_shutters(lines, scenario);
  warn_about_capture_traffic(lines, scenario);
  warn_about_evaluation(lines, scenario);
  warn_about_idle_hosts(lines, scenario);
  warn_about_controls(lines, scenario);
  warn_about_wires(lines, scenario);
  warn_about_wifi(lines, scenario);
  warn_about_temperature(lines, scenario);
  warn_about_oscillators(lines, scenario);
  warn_about_studio(lines, scenario);
  return lines;
}

}  // namespace

std::vector<std::string> warnings(const Scenario& scenario) {
  std::vector<std::string> lines;
  for (const Warning& warning : all_warnings(scenario)) {
    lines.push_back(scenario.origin->describe(warning.pointer) + ": " + warning.text);
  }
  return lines;
}

std::vector<std::string> loss_reasons(const Scenario& scenario) {
  std::vector<std::string> reasons;
  if (scenario.cameras.streams.empty()) return reasons;  // of files: no world is stated
  Lines lines;
  warn_about_frames(lines, scenario);
  for (const Warning& warning : lines) {
    if (warning.loses_pulses) reasons.push_back(warning.pointer + ": " + warning.text);
  }
  if (scenario.cameras.drop_probability > 0) {
    reasons.push_back(
        fmt::format("/cameras/drop_probability: {:.3g} % of the frames are lost in "
                    "the cameras",
                    100 * scenario.cameras.drop_probability));
  }
  if (scenario.trigger.missed_pulse_probability > 0) {
    reasons.push_back(
        fmt::format("/trigger/missed_pulse_probability: {:.3g} % of the pulses never reach a "
                    "branch of the trigger",
                    100 * scenario.trigger.missed_pulse_probability));
  }
  if (!scenario.faults.empty()) {
    reasons.push_back(fmt::format("/faults: {} in this world", scenario.faults.size()));
  }
  return reasons;
}

}  // namespace simbench::scenarios
