#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/camera_profile.h"
#include "scenarios/frequency_limit.h"
#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

using Lines = std::vector<std::string>;

void warn(Lines& lines, const Scenario& scenario, const std::string& pointer,
          const std::string& text) {
  lines.push_back(scenario.origin->describe(pointer) + ": " + text);
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

void warn_about_usb(Lines& lines, const Scenario& scenario) {
  const Usb& usb = scenario.usb;
  constexpr std::int64_t kKnownToWork = 3;
  std::int64_t sharers = 1;
  if (usb.sharing != UsbSharing::kDedicated) {
    sharers = std::min(usb.cameras_per_controller, most_cameras_on_a_host(scenario));
  }
  const double offered = camera_load_mb_per_s(scenario) * static_cast<double>(sharers);
  if (offered > usb.bandwidth_mb_per_s) {
    warn(lines, scenario, "/usb/bandwidth_mb_per_s",
         fmt::format("{} camera(s) offer {:.1f} MB/s to a controller that carries {:g}: expect "
                     "{:.1f} % of their frames to be dropped",
                     sharers, offered, usb.bandwidth_mb_per_s,
                     100 * (1 - usb.bandwidth_mb_per_s / offered)));
  } else if (sharers > kKnownToWork) {
    warn(lines, scenario, "/usb/cameras_per_controller",
         fmt::format(
             "{} cameras share a controller; real controllers with more than {} are reported "
             "to give incomplete frames and drops (librealsense #4627), which the model does "
             "not show",
             sharers, kKnownToWork));
  }
}

// Exposures that do not end before the next pulse make the camera miss it.
void warn_about_exposure(Lines& lines, const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const double period_ms = 1e3 / scenario.trigger.pulse_rate_hz();
  const double readout_ms =
      std::ranges::max_element(cameras.streams, {}, &Stream::readout_ms)->readout_ms;
  const bool is_triggered = std::ranges::any_of(cameras.streams, [&cameras](const Stream& stream) {
    return cameras.follows_trigger(stream);
  });
  const double start_ms = is_triggered ? cameras.trigger_to_exposure_us * 1e-3 : 0;
  const auto warn_if_longer = [&](const std::string& pointer, double longest_ms) {
    if (start_ms + longest_ms <= period_ms) return;
    warn(
        lines, scenario, pointer,
        fmt::format("exposures of up to {:.2f} ms, beginning {:.2f} ms after the pulse, do not fit "
                    "into the frame period of {:.2f} ms: expect missed pulses and half the rate "
                    "(realsense-ros #2612)",
                    longest_ms, start_ms, period_ms));
  };
  warn_if_longer("/cameras/exposure_ms",
                 readout_ms + cameras.exposure_ms +
                     (cameras.exposure_camera_periods + cameras.exposure_host_periods) * period_ms);
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
    warn(lines, scenario, fmt::format("/cameras/streams/{}/shutter", i),
         fmt::format("{}, but the {} camera of the {} has a {} shutter", to_text(stream.shutter),
                     to_text(stream.kind), camera->name, to_text(profile->shutter)));
  }
}

// Capture traffic through the port of the busiest host.
void warn_about_capture_traffic(Lines& lines, const Scenario& scenario) {
  const Network& network = scenario.network;
  if (network.bandwidth_mbit_per_s == 0) return;
  const double offered_mbit_per_s = camera_load_mb_per_s(scenario) * 8 *
                                    static_cast<double>(most_cameras_on_a_host(scenario)) *
                                    network.capture_traffic_share;
  if (offered_mbit_per_s <= network.bandwidth_mbit_per_s) return;
  warn(lines, scenario, "/network/capture_traffic_share",
       fmt::format("the frames of a host are {:.0f} Mbit/s on a link that carries {:g}: what "
                   "finds more than a second of traffic queued is lost",
                   offered_mbit_per_s, network.bandwidth_mbit_per_s));
}

void warn_about_evaluation(Lines& lines, const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  const Stream& stream = *scenario.scored_stream();
  if (!cameras.follows_trigger(stream) && !cameras.frame_control) {
    warn(lines, scenario, "/evaluation/stream",
         fmt::format("in sync mode \"{}\" the {} stream does not follow the trigger: its frames "
                     "differ by up to a frame period",
                     to_text(cameras.sync_mode), to_text(stream.kind)));
  }
  if (scenario.timeline.warm_up_ms < cameras.unstable_start_ms) {
    warn(lines, scenario, "/timeline/warm_up_ms",
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
  warn(lines, scenario,
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
  warn(lines, scenario, "/network/wifi",
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
    warn(lines, scenario, fmt::format("/cameras/frame_control/{}", control),
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
  warn(lines, scenario, "/hosts/temperature",
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
  warn(lines, scenario, "/hosts/count",
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
    warn(lines, scenario, pointer,
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
    warn(lines, scenario, "/studio/radius_m",
         fmt::format("cameras are {:.3g} to {:.3g} m from the centre they look at and see from "
                     "{:g} to {:g} m",
                     sight.nearest_m, sight.farthest_m, studio.min_distance_m,
                     studio.max_distance_m));
  }
  const StudioSubject& subject = studio.subject;
  if (subject.motion == MotionScript::kWalkAndTurn && subject.turn_rate_rad_per_s > 0) {
    const double circle_m = subject.walk_speed_m_per_s / subject.turn_rate_rad_per_s;
    if (circle_m >= studio.radius_m) {
      warn(lines, scenario, "/studio/subject/walk_speed_m_per_s",
           fmt::format("the subject walks on a circle of {:.3g} m, the cameras stand on one of "
                       "{:g} m",
                       circle_m, studio.radius_m));
    }
  }
}

}  // namespace

std::vector<std::string> warnings(const Scenario& scenario) {
  Lines lines;
  warn_about_usb(lines, scenario);
  warn_about_exposure(lines, scenario);
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

}  // namespace simbench::scenarios
