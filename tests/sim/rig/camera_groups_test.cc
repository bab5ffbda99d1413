// Several camera models in one rig (/cameras/groups), against calculated values.
#include "scenarios/camera_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "scenarios/calibration.h"
#include "tests/nonempty.h"
#include "tests/sim/rig/captured_frames.h"
#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

constexpr double kLaterUs = 250;  // the second model's exposures

// One camera of each model: of the first 8 ms of latency and 2 ms of transfer, of the second 5 and
// 4 ms.
scenarios::Scenario two_models() {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.groups.resize(2);
  s.cameras.groups[0].count = 1;
  s.cameras.groups[1].count = 1;
  s.cameras.groups[1].height = 700;
  s.cameras.groups[1].pipeline_latency_ms = 5;
  s.cameras.groups[1].trigger_to_exposure_us = kLaterUs;
  return s;
}

double pulse_ms(const FrameTruth& truth) { return static_cast<double>(truth.pulse) * 1e3 / 45; }

TEST(CameraGroups, ExposuresDifferByTheirStartDelays) {
  const CapturedFrames result = capture(two_models());
  for (const auto& [record, truth] : nonempty(result.frames)) {
    const double later_ms = record.camera == 1 ? kLaterUs * 1e-3 : 0;
    EXPECT_NEAR(to_ms(truth.exposure_start.time_since_epoch()), pulse_ms(truth) + later_ms, 2e-6);
    EXPECT_NEAR(record.sensor.us, (pulse_ms(truth) + later_ms + 2) * 1e3, 1);
  }
  EXPECT_EQ(result.of(0).size(), result.of(1).size());
}

TEST(CameraGroups, FramesArriveAfterTheLatencyAndTheTransferOfTheirModel) {
  const CapturedFrames result = capture(two_models());
  for (const auto& [record, truth] : nonempty(result.frames)) {
    const double delay_ms = record.camera == 1 ? kLaterUs * 1e-3 + 4 + 5 + 4 : 4 + 8 + 2;
    EXPECT_NEAR(host_ms_of(record.arrival), pulse_ms(truth) + delay_ms, 3e-6);
  }
}

// Frames of one model share a controller with each other, and not with the other's.
TEST(CameraGroups, AControllerCarriesItsOwnModel) {
  scenarios::Scenario s = two_models();
  s.hosts.count = 1;
  s.cameras.count = 4;
  s.cameras.cameras_per_host = 4;
  s.cameras.groups[0].count = 2;
  s.cameras.groups[1].count = 2;
  s.usb.cameras_per_controller = 2;
  s.usb.sharing = scenarios::UsbSharing::kFair;
  for (const auto& [record, truth] : nonempty(capture(s).frames)) {
    const double delay_ms = record.camera >= 2 ? kLaterUs * 1e-3 + 4 + 5 + 8 : 4 + 8 + 4;
    EXPECT_NEAR(host_ms_of(record.arrival), pulse_ms(truth) + delay_ms, 3e-6) << record.camera;
  }
}

TEST(CameraGroups, ExposureTimesAreThoseOfTheGroup) {
  scenarios::Scenario s = two_models();
  s.cameras.groups[1].exposure_ms = 6;
  const CapturedFrames result = capture(s);
  EXPECT_EQ(result.of(0).front().record.exposure_us, 4000U);
  EXPECT_EQ(result.of(1).front().record.exposure_us, 6000U);
}

TEST(CameraGroups, ClocksHaveTheSkewOfTheirGroup) {
  scenarios::Scenario s = two_models();
  s.cameras.groups[1].skew_sigma_ppm = 50;
  const CapturedFrames result = capture(s);
  const auto error_us = [&](std::uint32_t camera) {
    const CapturedFrames::Frame last = result.of(camera).back();
    const double later_ms = camera == 1 ? kLaterUs * 1e-3 : 0;
    return last.record.sensor.us - (pulse_ms(last.truth) + later_ms + 2) * 1e3;
  };
  EXPECT_NEAR(error_us(0), 0, 1);
  EXPECT_GT(std::abs(error_us(1)), 3);
}

TEST(CameraGroups, StampsJitterWhereTheGroupSays) {
  scenarios::Scenario s = two_models();
  s.cameras.groups[1].sensor_stamp_jitter_sigma_us = 20;
  double largest_us = 0;
  for (const auto& [record, truth] : nonempty(capture(s).frames)) {
    const double later_ms = record.camera == 1 ? kLaterUs * 1e-3 : 0;
    const double error_us = record.sensor.us - (pulse_ms(truth) + later_ms + 2) * 1e3;
    if (record.camera == 1) {
      largest_us = std::max(largest_us, std::abs(error_us));
    } else {
      EXPECT_NEAR(error_us, 0, 1);
    }
  }
  EXPECT_GT(largest_us, 20);
}

TEST(CameraGroups, CalibratedDelaysAreOfEachGroup) {
  const scenarios::Scenario s = two_models();
  const auto delay_ms = [&](std::size_t group) {
    const scenarios::Scenario alone = scenarios::group_alone(s, group);
    return scenarios::calibrated_delay_ms(alone, alone.cameras.streams.front());
  };
  EXPECT_DOUBLE_EQ(delay_ms(0), 10);
  EXPECT_DOUBLE_EQ(delay_ms(1), 9);
}

// Pulses of 45 Hz, of which the second camera gets every third.
TEST(CameraGroups, AGroupExposesAtOnePulseOfSoMany) {
  scenarios::Scenario s = two_models();
  s.cameras.groups[1].pulses_per_frame = 3;
  const CapturedFrames result = capture(s);
  std::int64_t expected = 0;
  for (const CapturedFrames::Frame& frame : nonempty(result.of(1))) {
    EXPECT_EQ(frame.truth.pulse, expected);
    EXPECT_EQ(frame.record.counter, static_cast<std::uint32_t>(expected / 3));
    expected += 3;
  }
  EXPECT_GE(result.of(0).size(), 3 * result.of(1).size() - 2);
}

// A triggered camera exposes from the pulse on, whatever its mode and exposure are.
TEST(CameraGroups, TriggeredExposuresBeginAtThePulse) {
  scenarios::Scenario s = two_models();
  s.cameras.sync_mode = scenarios::SyncMode::kSlave;
  s.cameras.model = "basler_aca1920_155um";
  s.cameras.streams[0].kind = StreamKind::kColour;
  s.evaluation.stream = StreamKind::kColour;
  s.cameras.groups[1].mode_rate_hz = 50;
  s.cameras.groups[1].exposure_ms = 9;
  for (const auto& [record, truth] : nonempty(capture(s).frames)) {
    const double later_ms = record.camera == 1 ? kLaterUs * 1e-3 : 0;
    EXPECT_NEAR(to_ms(truth.exposure_start.time_since_epoch()), pulse_ms(truth) + later_ms, 2e-6);
    EXPECT_EQ(truth.exposure_end - truth.exposure_start, from_ms(record.camera == 1 ? 9 : 4));
  }
}

// A group that states nothing is as the rest.
TEST(CameraGroups, EqualGroupsAreNoGroups) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.oscillator.skew_sigma_ppm = 20;
  s.usb.delivery_jitter_transfers = 0.3;
  const CapturedFrames without = capture(s);
  s.cameras.groups.resize(2);
  s.cameras.groups[0].count = 1;
  s.cameras.groups[1].count = 1;
  const CapturedFrames with = capture(s);
  ASSERT_EQ(with.frames.size(), without.frames.size());
  for (std::size_t i = 0; i < with.frames.size(); ++i) {
    EXPECT_EQ(with.frames[i].record.arrival, without.frames[i].record.arrival);
    EXPECT_EQ(with.frames[i].record.sensor.us, without.frames[i].record.sensor.us);
  }
}

}  // namespace
}  // namespace simbench::sim
