#include "evaluation/diagnosis/camera_delays.h"

#include <gmock/gmock.h>

#include "tests/evaluation/diagnosis/clocked_rig.h"

namespace simbench::evaluation {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(CameraDelays, LeavesTheUnsteadyStartOut) {
  const auto delays = camera_delays(rig_recording({.name = "a", .delivery_sd_ms = 0.2}));
  ASSERT_TRUE(delays);
  EXPECT_EQ(delays->left_out, 150U);
  EXPECT_EQ(delays->delay_ms.size(), 1650U);
  EXPECT_NEAR(delays->period_ms, kRigPeriodMs, 0.05);
  EXPECT_NEAR(delays->noise_ms, 0.2, 0.02);
  EXPECT_FALSE(delays->stamp_ms);
}

TEST(CameraDelays, StampsOfAnotherUnitAreRefused) {
  RecordedStream stream = rig_recording({.name = "a"});
  for (StampedFrame& frame : stream.frames) frame.sensor /= 1000;
  EXPECT_FALSE(camera_delays(stream));
}

TEST(CameraDelays, ArrivalsThatAreTheStampsAreRefused) {
  RecordedStream stream = rig_recording({.name = "a"});
  for (StampedFrame& frame : stream.frames) frame.sensor = frame.arrival;
  EXPECT_FALSE(camera_delays(stream));
}

TEST(CameraDelays, FindsAJumpOfTheClockToTheFrame) {
  const auto delays = camera_delays(rig_recording({.name = "a", .error_s = step_at(30, 0.004)}));
  const std::vector<DelayJump> jumps = delay_jumps(*delays);
  ASSERT_THAT(jumps, SizeIs(1));
  EXPECT_NEAR(jumps[0].step_ms, 4, 0.1);
  EXPECT_NEAR(jumps[0].at_s, 30, 0.05);
}

TEST(CameraDelays, NoiseIsNoJump) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const auto delays =
        camera_delays(rig_recording({.name = "a", .delivery_sd_ms = 0.5, .seed = seed}));
    EXPECT_THAT(delay_jumps(*delays), IsEmpty());
  }
}

TEST(CameraDelays, ABusyHostIsNoJump) {
  RecordedStream stream = rig_recording({.name = "a"});
  for (std::size_t i = 600; i < 640; ++i) stream.frames[i].arrival += from_ms(20);
  EXPECT_THAT(delay_jumps(*camera_delays(stream)), IsEmpty());
}

TEST(CameraDelays, TheRobustDeviationIsThatOfNormalNoise) {
  EXPECT_NEAR(robust_deviation({1, 2, 3, 4, 1000}), 1.4826, 1e-9);
}

}  // namespace
}  // namespace simbench::evaluation
