// Pulses faster than a mode can follow: which of them expose, and what rate the frames have.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <vector>

#include "sim/rig/camera_world.h"
#include "tests/nonempty.h"
#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

// 90 Hz modes, 480 pulses.
scenarios::Scenario at_rate(scenarios::SyncMode mode, double rate_hz) {
  scenarios::Scenario scenario = ideal_scenario();
  scenario.cameras.sync_mode = mode;
  scenario.trigger.rate_hz = rate_hz;
  scenario.timeline.frames = 480;
  return scenario;
}

// The frames of every camera from the first pulse on.
std::map<std::uint32_t, std::vector<SimFrame>> frames_of_cameras(
    const scenarios::Scenario& scenario) {
  std::map<std::uint32_t, std::vector<SimFrame>> frames;
  CameraWorld world(scenario, 1);
  for (std::size_t i = 0; const CameraPeriod* period = world.period(i); ++i) {
    for (const SimFrame& frame : period->frames) frames[frame.camera].push_back(frame);
  }
  return frames;
}

// That each camera exposes at one pulse in so many, and counts what it exposes.
void expect_pulses_per_frame(const scenarios::Scenario& scenario, std::int64_t pulses) {
  EXPECT_EQ(scenario.pulses_per_frame(scenario.cameras.streams[0]), pulses);
  EXPECT_DOUBLE_EQ(scenario.frame_rate_hz(scenario.cameras.streams[0]),
                   scenario.trigger.rate_hz / static_cast<double>(pulses));
  const double interval_ms = static_cast<double>(pulses) * scenario.trigger.period_ms();
  for (const auto& [camera, frames] : nonempty(frames_of_cameras(scenario))) {
    SCOPED_TRACE(testing::Message() << "camera " << camera);
    EXPECT_EQ(frames.size(), static_cast<std::size_t>(frames.back().pulse / pulses + 1));
    for (std::size_t i = 0; i < frames.size(); ++i) {
      ASSERT_EQ(frames[i].pulse, static_cast<std::int64_t>(i) * pulses);
      ASSERT_EQ(frames[i].counter, i);
      if (i == 0) continue;
      ASSERT_NEAR(to_ms(frames[i].exposure_start - frames[i - 1].exposure_start), interval_ms,
                  2e-6);
    }
  }
}

TEST(PulseRate, GenlockAtTheFullRateOfTheModeShowsHalfOfIt) {
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kGenlock, 45), 1);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kGenlock, 90), 2);
}

// Pulses are ignored for 1.96 mode periods, 21.8 ms.
TEST(PulseRate, GenlockAnswersTheFirstPulseAfterTwoModePeriodsLessTheGuard) {
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kGenlock, 45.9), 1);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kGenlock, 46), 2);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kGenlock, 60), 2);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kGenlock, 91.8), 2);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kGenlock, 91.9), 3);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kGenlock, 200), 5);
}

TEST(PulseRate, SlavesIgnorePulsesWithinAModePeriodLessTheGuard) {
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kSlave, 90), 1);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kSlave, 91.8), 1);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kSlave, 92), 2);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kFullSlave, 180), 2);
  expect_pulses_per_frame(at_rate(scenarios::SyncMode::kSlave, 200), 3);
}

TEST(PulseRate, AFreeRunningStreamKeepsItsOwn) {
  const scenarios::Scenario scenario = at_rate(scenarios::SyncMode::kDefault, 200);
  EXPECT_EQ(scenario.pulses_per_frame(scenario.cameras.streams[0]), 1);
  EXPECT_EQ(scenario.frame_rate_hz(scenario.cameras.streams[0]), 90);
}

}  // namespace
}  // namespace simbench::sim
