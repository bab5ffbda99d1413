// A run made by hand for the tests of figures: every frame is where the test expects it.
//
// Pulse p is at p * 20 ms of true time, which is also the master's clock; 3 pulses of warm-up, 10
// evaluated. Cameras have registers that began 1000 ms apart. Hosts' clocks are off by `host_ms`,
// so global stamps and arrivals (5 ms late) are too.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/run/run_detail.h"

namespace simbench::reports {

inline constexpr double kPeriodMs = 20;

// As many cameras on each host; host h is off by host_ms[h].
inline evaluation::RunDetail hand_made_run(const std::vector<double>& host_ms,
                                           std::size_t cameras_per_host,
                                           const std::string& pipeline = "mine") {
  evaluation::RunDetail run;
  run.scenario = "hand_made";
  run.pipeline = pipeline;
  run.seed = 7;
  run.frame_rate_hz = 1000 / kPeriodMs;
  run.host_count = host_ms.size();
  run.camera_count = host_ms.size() * cameras_per_host;
  run.first_pulse = 3;
  run.pulses = 10;
  run.gathering_interval_ms = kPeriodMs / 2;
  run.has_truth = true;
  run.has_pulses = true;
  run.capture_start_ms = 0;
  run.evaluated_start_ms = 3 * kPeriodMs;
  run.capture_end_ms = 13 * kPeriodMs;
  for (std::size_t camera = 0; camera < run.camera_count; ++camera) {
    evaluation::CameraDetail detail;
    detail.host = static_cast<std::uint32_t>(camera / cameras_per_host);
    for (std::uint32_t pulse = 0; pulse < 13; ++pulse) {
      const double at_ms = kPeriodMs * pulse;
      evaluation::FrameDetail frame;
      frame.counter = pulse;
      frame.pulse = pulse;
      frame.in_warm_up = pulse < 3;
      frame.evaluated = !frame.in_warm_up;
      frame.sensor_ms = at_ms + 1000 * static_cast<double>(camera);
      frame.frame_ms = frame.sensor_ms + 2;
      frame.backend_ms = at_ms + 4 + host_ms[detail.host];
      frame.arrival_ms = at_ms + 5 + host_ms[detail.host];
      frame.from_start_ms = at_ms + host_ms[detail.host];
      frame.reference_ms = at_ms;
      frame.own_host_ms = at_ms + host_ms[detail.host];
      frame.exposure_start_ms = at_ms - 1;
      frame.exposure_end_ms = at_ms + 1;
      if (frame.evaluated) {
        frame.global_ms = at_ms + host_ms[detail.host];
        frame.online_ms = frame.global_ms;
        frame.offline_ms = frame.global_ms;
      }
      detail.frames.push_back(frame);
    }
    run.cameras.push_back(detail);
  }
  for (std::int64_t pulse = 3; pulse < 13; ++pulse) {
    evaluation::SetDetail set;
    for (std::uint32_t camera = 0; camera < run.camera_count; ++camera) {
      set.members.push_back({camera, static_cast<std::size_t>(pulse)});
    }
    set.pulse = pulse;
    set.complete = true;
    set.pure = true;
    run.sets.push_back(set);
  }
  return run;
}

}  // namespace simbench::reports
