// A pipeline with a capture_alignment on real hosts: nodes of the real program, over loopback, with
// cameras that play a recording.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hardware/conductor/rig_source.h"
#include "hardware/experiment/experiment_rig.h"
#include "recording/event.h"
#include "scenarios/loader.h"
#include "tests/cli/program.h"

namespace simbench {
namespace {

using testing::Contains;
using testing::IsEmpty;

constexpr int kRateHz = 40;
constexpr double kPeriodMs = 1e3 / kRateHz;  // a whole number of microseconds
constexpr int kFrames = 120;
constexpr double kPhaseMs = 9;  // of camera 1, behind camera 0

// Two hosts of one camera each, whose frames a program may make longer and shorter by 10 us.
scenarios::Scenario pair_of_cameras() {
  return scenarios::load_scenario(
      "6node_relay",
      {{"/hosts/count", "2"},
       {"/cameras/count", "2"},
       {"/cameras/cameras_per_host", "1"},
       {"/cameras/exposure_ms", "2"},
       {"/cameras/frame_control",
        R"({"adjust_frame": true, "insert_frame": true, "frame_length": true, "start_at": false,
            "granularity_us": 10, "shortest_ms": 12, "longest_ms": 60, "latency_frames": 2,
            "delay_ms": 0, "delay_exponential_ms": 0, "loss_probability": 0, "insert_stretches": 1,
            "insert_noise_sigma_us": 0, "start_jitter_sigma_us": 0, "frame_jitter_sigma_us": 0,
            "sensor_clock": "camera"})"},
       {"/network/loss_probability", "0"},
       {"/trigger/rate_hz", std::to_string(kRateHz)},
       {"/timeline/wait_before_capture_ms", "0"},
       {"/timeline/warm_up_ms", "0"},
       {"/timeline/frames", std::to_string(kFrames)},
       {"/pipelines",
        R"([{"name": "phase_rate", "host_sync": "free_running", "capture_alignment": "phase_rate",
             "device_time": "hull_300", "gathering": "yoon2021"},
            {"name": "rpi_sync", "host_sync": "free_running", "capture_alignment": "rpi_sync",
             "device_time": "hull_300", "gathering": "yoon2021"}])"}});
}

// What is recorded of cameras that run free, each frame delivered as long after its exposure.
std::string frames_to_play() {
  std::string text = "Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host\n";
  for (int camera = 0; camera < 2; ++camera) {
    for (int frame = 0; frame < 2 * kFrames; ++frame) {
      const double at_ms = frame * kPeriodMs + camera * kPhaseMs;
      text += fmt::format("Depth,0,{},{:.1f},{:.1f},camera{},host\n", frame, 5000 + at_ms,
                          100 + at_ms, camera);
    }
  }
  return text;
}

class SteeredNodes : public ProgramTest, public testing::WithParamInterface<const char*> {
 protected:
  // From each frame of camera 0 to the nearest of camera 1, in ms of this machine's clock.
  static std::vector<double> distances_ms(const KeptRecording& recording,
                                          const std::vector<hardware::HostReport>& hosts) {
    std::vector<double> of_camera_ms[2];
    for (const KeptEvent& event : recording.events()) {
      const auto* frame = event_as<FrameEvent>(event);
      if (frame == nullptr) continue;
      const std::uint32_t camera = frame->record.camera;
      const auto arrived = hosts[camera].oscillator.when(frame->record.arrival_steady);
      of_camera_ms[camera].push_back(to_ms(arrived.time_since_epoch()));
    }
    std::vector<double> distances;
    distances.reserve(of_camera_ms[0].size());
    for (const double at_ms : of_camera_ms[0]) {
      double nearest_ms = kPeriodMs;
      for (const double other_ms : of_camera_ms[1]) {
        nearest_ms = std::min(nearest_ms, std::abs(other_ms - at_ms));
      }
      distances.push_back(nearest_ms);
    }
    return distances;
  }
};

INSTANTIATE_TEST_SUITE_P(CaptureAlignment, SteeredNodes, testing::Values("phase_rate", "rpi_sync"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(SteeredNodes, ExposuresComeTogether) {
  const scenarios::Scenario scenario = pair_of_cameras();
  file("played.csv", frames_to_play());
  const hardware::ExperimentRig rig({.scenario = &scenario,
                                     .recording = folder() / "played.csv",
                                     .clocks = {{}, {}},
                                     .program = SIMBENCH_PROGRAM});
  hardware::RigSource source(rig.conductor(), rig.key(), scenario, {});
  KeptRecording recording;
  const RecordingCost cost = source.record({.seed = 1, .pipeline = GetParam()}, recording);
  EXPECT_THAT(cost.notes, IsEmpty());

  const std::vector<double> distances = distances_ms(recording, source.hosts());
  ASSERT_GE(distances.size(), static_cast<std::size_t>(kFrames));
  const auto half = distances.begin() + kFrames / 2;
  // No method sends a control before its twentieth frame. Until both cameras have followed theirs
  // the distance may be anything.
  for (int frame = 0; frame < 20; ++frame)
    EXPECT_NEAR(distances[static_cast<std::size_t>(frame)], kPhaseMs, 1e-3);
  // A granule of 10 us each, and at most 50 us in which rpi_sync does nothing. Beyond that the two
  // processes have read the machine's clock at their start, with microseconds in between.
  EXPECT_LT(*std::max_element(half, distances.begin() + kFrames), 0.2);

  std::vector<AlignmentReport> reports;
  for (const KeptEvent& event : recording.events()) {
    if (const auto* report = event_as<AlignmentReport>(event)) reports.push_back(*report);
  }
  EXPECT_THAT(reports, Contains(testing::Field(&AlignmentReport::aligned, true)));
  for (const std::uint32_t camera : {0U, 1U}) {
    EXPECT_THAT(reports, Contains(testing::Field(&AlignmentReport::camera, camera)));
  }
}

}  // namespace
}  // namespace simbench
