#include "scenarios/frame_control_checks.h"

#include <fmt/format.h>

#include <cstddef>

#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

void check_clock(const Scenario& scenario) {
  const Cameras& cameras = scenario.cameras;
  if (cameras.frame_control && cameras.frame_control->sensor_clock == ClockOwner::kHost) {
    if (cameras.stamp_clock != ClockOwner::kHost) {
      fail_at(scenario, "/cameras/frame_control/sensor_clock",
              "found \"host\", allowed \"camera\" where the stamps are of the camera's own clock "
              "(/cameras/stamp_clock)");
    }
    if (!cameras.skew_of_camera_ppm.empty()) {
      fail_at(scenario, "/cameras/skew_of_camera_ppm",
              "found skews, allowed none where the hosts' oscillators count the frames "
              "(/cameras/frame_control/sensor_clock)");
    }
  }
  if (cameras.stamp_clock != ClockOwner::kHost || !cameras.clock_poll.is_on()) return;
  fail_at(scenario, "/cameras/clock_poll/interval_ms",
          fmt::format("found {}, allowed 0 where cameras stamp with their host's clock "
                      "(/cameras/stamp_clock): they have no other that could be polled",
                      cameras.clock_poll.interval_ms));
}

void check_lengths(const Scenario& scenario, const FrameControlModel& control) {
  if (control.granularity_us * 1e-3 > control.shortest_ms) {
    fail_at(scenario, "/cameras/frame_control/granularity_us",
            fmt::format("found {}, allowed at most the shortest frame, {} ms "
                        "(/cameras/frame_control/shortest_ms)",
                        control.granularity_us, control.shortest_ms));
  }
  if (control.shortest_ms > control.longest_ms) {
    fail_at(scenario, "/cameras/frame_control/shortest_ms",
            fmt::format("found {}, allowed at most /cameras/frame_control/longest_ms, {}",
                        control.shortest_ms, control.longest_ms));
  }
  const double period_ms = scenario.trigger.period_ms();
  if (period_ms >= control.shortest_ms && period_ms <= control.longest_ms) return;
  fail_at(
      scenario, "/trigger/rate_hz",
      fmt::format("found {}, a grid that the cameras' rate cannot reach: frames of {:.6g} ms, "
                  "allowed {} to {} ms (/cameras/frame_control/shortest_ms, longest_ms)",
                  scenario.trigger.rate_hz, period_ms, control.shortest_ms, control.longest_ms));
}

// A frame that is a granule shorter still has room for the exposure.
void check_exposures(const Scenario& scenario, const FrameControlModel& control) {
  const Cameras& cameras = scenario.cameras;
  const double period_ms = scenario.trigger.period_ms();
  const double room_ms = period_ms - control.granularity_us * 1e-3;
  const auto check_longest = [&](const char* pointer, double longest_ms) {
    if (longest_ms <= room_ms) return;
    fail_at(scenario, pointer,
            fmt::format("found exposures of up to {:.6g} ms, allowed at most {:.6g} ms: a frame of "
                        "{:.6g} ms less a granule of /cameras/frame_control/granularity_us",
                        longest_ms, room_ms, period_ms));
  };
  const double spread_periods = cameras.exposure_camera_periods + cameras.exposure_host_periods;
  check_longest("/cameras/exposure_ms", cameras.exposure_ms + spread_periods * period_ms);
  if (cameras.auto_exposure.is_on()) {
    check_longest("/cameras/auto_exposure/max_ms", cameras.auto_exposure.max_ms);
  }
  const double readout_ms = cameras.streams.front().readout_ms;
  if (readout_ms <= period_ms) return;
  fail_at(scenario, "/cameras/streams/0/readout_ms",
          fmt::format("found {}, allowed at most the length of a frame, {:.6g} ms: the next one's "
                      "readout begins then",
                      readout_ms, period_ms));
}

}  // namespace

void check_frame_control(const Scenario& scenario) {
  check_clock(scenario);
  if (!scenario.cameras.frame_control) return;
  const FrameControlModel& control = *scenario.cameras.frame_control;
  if (const std::size_t streams = scenario.cameras.streams.size(); streams != 1) {
    fail_at(scenario, "/cameras/streams",
            fmt::format("found {} streams, allowed 1 with /cameras/frame_control: it is one "
                        "sensor's frames that are steered",
                        streams));
  }
  check_lengths(scenario, control);
  check_exposures(scenario, control);
}

}  // namespace simbench::scenarios
