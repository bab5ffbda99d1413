// What cameras do in a capture: exposures, shutters, clocks and models.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/nonempty.h"
#include "tests/sim/rig/captured_frames.h"
#include "tests/sim/rig/ideal_scenario.h"

namespace simbench::sim {
namespace {

TEST(CaptureCameras, ExposureOfTheHostAndOfTheCameraScaleWithThePeriod) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.count = 6;
  s.cameras.cameras_per_host = 3;
  s.cameras.exposure_host_periods = 0.2;
  const CapturedFrames by_host = capture(s, 5);
  EXPECT_EQ(by_host.of(0)[0].record.exposure_us, by_host.of(2)[0].record.exposure_us);
  EXPECT_NE(by_host.of(0)[0].record.exposure_us, by_host.of(3)[0].record.exposure_us);
  s.trigger.rate_hz = 15;
  s.cameras.streams[0].mode_rate_hz = 30;
  const CapturedFrames slower = capture(s, 5);
  const double extra_45 = by_host.of(0)[0].record.exposure_us - 4000.0;
  const double extra_15 = slower.of(0)[0].record.exposure_us - 4000.0;
  EXPECT_NEAR(extra_15 / extra_45, 3, 0.01);
}

TEST(CaptureCameras, ExposuresAreUnsteadyAfterTheStartOnly) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.unstable_start_ms = 500;
  s.cameras.unstable_start_jitter_sigma_ms = 1;
  double largest_before = 0;
  for (const auto& [record, truth] : nonempty(capture(s).frames)) {
    const double pulse_ms = static_cast<double>(truth.pulse) * 1e3 / 45;
    const double late_ms = to_ms(truth.exposure_start.time_since_epoch()) - pulse_ms;
    if (pulse_ms < 500) {
      EXPECT_GE(late_ms, -2e-6);
      largest_before = std::max(largest_before, late_ms);
    } else {
      EXPECT_NEAR(late_ms, 0, 2e-6);
    }
  }
  EXPECT_GT(largest_before, 0.5);
}

TEST(CaptureCameras, ARollingShutterLastsLongerThanItsExposure) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.streams[0].shutter = scenarios::ShutterKind::kRolling;
  s.cameras.streams[0].readout_ms = 6;
  for (const auto& [record, truth] : nonempty(capture(s).frames)) {
    const double pulse_us = static_cast<double>(truth.pulse) * 1e6 / 45;
    // Rows begin between 0 and 6 ms after the pulse and last 4 ms each.
    EXPECT_EQ(truth.exposure_end - truth.exposure_start, from_ms(10));
    EXPECT_EQ(record.exposure_us, 4000u);
    EXPECT_NEAR(record.sensor.us, pulse_us + 5000, 1);  // middle of the middle row
    EXPECT_NEAR(record.frame.us, pulse_us + 4000, 1);   // the first row is read out
    EXPECT_NEAR(host_ms_of(record.arrival), pulse_us * 1e-3 + 10 + 8 + 2, 2e-6);
  }
  s.cameras.streams[0].shutter = scenarios::ShutterKind::kGlobal;
  EXPECT_EQ(capture(s).frames[0].truth.exposure_end, TrueTime(from_ms(4)));
}

TEST(CaptureCameras, AutoExposureStepsTheExposuresOfEachCamera) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.auto_exposure = {.step_interval_exponential_ms = 300, .min_ms = 1, .max_ms = 7};
  const CapturedFrames result = capture(s);
  std::vector<std::uint32_t> differing(2);
  for (const std::uint32_t camera : {0u, 1u}) {
    const auto frames = result.of(camera);
    EXPECT_EQ(frames[0].record.exposure_us, 4000u);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      EXPECT_EQ((frames[i].truth.exposure_end - frames[i].truth.exposure_start).count() / 1000,
                frames[i].record.exposure_us);
      differing[camera] += frames[i].record.exposure_us != frames[i - 1].record.exposure_us ? 1 : 0;
    }
    // 3 s are 10 steps on average.
    EXPECT_GT(differing[camera], 2u);
    EXPECT_LT(differing[camera], 25u);
  }
  EXPECT_NE(result.of(0).back().record.exposure_us, result.of(1).back().record.exposure_us);
}

TEST(CaptureCameras, LatencyOfACameraIsItsOwnAndConstant) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.latency_camera_max_ms = 5;
  const CapturedFrames result = capture(s);
  double first_ms[2] = {};
  for (const auto& [record, truth] : nonempty(result.frames)) {
    const double extra_ms =
        host_ms_of(record.arrival) - static_cast<double>(truth.pulse) * 1e3 / 45 - 14;
    if (truth.pulse == 0) first_ms[record.camera] = extra_ms;
    EXPECT_NEAR(extra_ms, first_ms[record.camera], 3e-6);
    EXPECT_GE(extra_ms, -2e-6);
    EXPECT_LT(extra_ms, 5);
  }
  EXPECT_GT(std::abs(first_ms[0] - first_ms[1]), 1e-3);
}

TEST(CaptureCameras, CamerasWarmUpFromTheirStart) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.oscillator.self_heating_ppm = 100;
  s.cameras.oscillator.self_heating_time_constant_s = 1;
  const auto frames = capture(s).of(0);
  const double s_on = static_cast<double>(frames.back().truth.pulse) / 45 + 0.002;
  const double ahead_us = 100 * (s_on - 1 + std::exp(-s_on));
  EXPECT_NEAR(frames.back().record.sensor.us, s_on * 1e6 + ahead_us, 1.01);
  EXPECT_GT(ahead_us, 190);
}

TEST(CaptureCameras, TheDeviceClockWrapsDuringACapture) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.clock_epoch_max_ms = 2 * 4294967.296;
  s.cameras.oscillator.skew_sigma_ppm = 20;
  s.timeline.frames = 45 * 4300;  // longer than 2^32 us
  s.cameras.count = 1;
  s.hosts.count = 1;
  const auto frames = capture(s).of(0);
  int wraps = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const std::uint32_t step = frames[i].record.sensor.us - frames[i - 1].record.sensor.us;
    EXPECT_NEAR(step, 22222, 3);  // modulo 2^32
    wraps += frames[i].record.sensor.us < frames[i - 1].record.sensor.us ? 1 : 0;
  }
  EXPECT_EQ(wraps, 1);
}

// 37 s of TAI less UTC, and a clock that began an hour later than the host's.
TEST(CaptureCameras, StampsOfTheHostsClockMayCountFromAnotherEpoch) {
  scenarios::Scenario s = ideal_scenario();
  s.cameras.stamp_clock = scenarios::ClockOwner::kHost;
  const CapturedFrames same = capture(s);
  s.cameras.stamp_epoch_of_camera_s = {37, -3600};
  const CapturedFrames other = capture(s);
  ASSERT_EQ(other.frames.size(), same.frames.size());
  for (std::size_t i = 0; i < same.frames.size(); ++i) {
    const FrameRecord& before = same.frames[i].record;
    const FrameRecord& after = other.frames[i].record;
    const auto epoch_us =
        static_cast<std::uint32_t>(before.camera == 0 ? 37'000'000LL : -3'600'000'000LL);
    EXPECT_EQ(after.sensor.us - before.sensor.us, epoch_us);
    EXPECT_EQ(after.frame.us - before.frame.us, epoch_us);
    EXPECT_EQ(after.arrival, before.arrival);
  }
}

// Frames of 45 Hz come every 22.2 ms, and each takes the program 40 ms.
TEST(CaptureCameras, AReaderThatIsTooSlowLetsFramesWaitAndThenDrop) {
  scenarios::Scenario s = ideal_scenario();
  s.timeline.frames = 450;
  const auto all = capture(s).of(0);
  s.hosts.frame_reader = scenarios::FrameReader{
      .frame_ms = 40, .queue_frames = 4, .full_queue = scenarios::FullQueue::kDropsNewest};
  const auto taken = capture(s).of(0);
  EXPECT_NEAR(static_cast<double>(taken.size()), static_cast<double>(all.size()) * (1e3 / 45) / 40,
              6);
  for (std::size_t i = 100; i < taken.size() - 8; ++i) {
    EXPECT_EQ(taken[i].record.arrival - taken[i - 1].record.arrival, from_ms(40));
    // Let in up to a period after a frame was taken, it waits for the rest of that and for three.
    const Nanoseconds exposed_ago = taken[i].record.arrival - taken[i].truth.own_host;
    EXPECT_GT(exposed_ago, from_ms(12 + 4 * 40 - 1e3 / 45) - Nanoseconds(2));
    EXPECT_LE(exposed_ago, from_ms(12 + 4 * 40) + Nanoseconds(2));
  }
}

TEST(CaptureCameras, APublisherPassesOnOneFrameInSoMany) {
  scenarios::Scenario s = ideal_scenario();
  s.hosts.frame_reader = scenarios::FrameReader{.frame_ms = 0,
                                                .queue_frames = 1,
                                                .full_queue = scenarios::FullQueue::kDropsOldest,
                                                .passed_every = 3};
  const CapturedFrames passed = capture(s);
  for (const std::uint32_t camera : {0U, 1U}) {
    std::uint32_t expected = 0;
    for (const auto& frame : nonempty(passed.of(camera))) {
      EXPECT_EQ(frame.record.counter, expected);
      expected += 3;
    }
  }
  EXPECT_EQ(s.pulses_per_passed_frame(s.cameras.streams[0]), 3);
  EXPECT_EQ(s.pulses_per_frame(s.cameras.streams[0]), 1);
}

TEST(CaptureCameras, TheModelSaysWhichStreamsFollowASlavesTrigger) {
  scenarios::Scenario s = ideal_scenario();
  s.trigger.rate_hz = 30;
  s.cameras.streams[0].mode_rate_hz = 30;
  s.cameras.streams.push_back(s.cameras.streams[0]);
  s.cameras.streams[1].kind = StreamKind::kColour;
  s.cameras.sync_mode = scenarios::SyncMode::kSlave;
  for (const auto& [model, follows] : {std::pair{"azure_kinect", true}, std::pair{"d435", false}}) {
    s.cameras.model = model;
    const auto frames = capture(s).of(0, StreamKind::kColour);
    ASSERT_FALSE(frames.empty());
    for (const auto& frame : frames) EXPECT_EQ(frame.truth.pulse != kNoPulse, follows) << model;
  }
}

}  // namespace
}  // namespace simbench::sim
