#include <gmock/gmock.h>

#include <algorithm>

#include "algorithms/capture_alignment/steered_camera.h"
#include "tests/algorithms/capture_alignment/fake_camera.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using ::testing::HasSubstr;

constexpr Nanoseconds kSlot = from_ms(30);

Nanoseconds largest_slot_error(const FakeCamera& camera, Nanoseconds since) {
  Nanoseconds largest{};
  for (const Nanoseconds middle : nonempty(camera.middles())) {
    if (middle < since) continue;
    largest = std::max(largest, std::chrono::abs(phase_error(middle, kSlot)));
  }
  return largest;
}

// 14 ms at no more than 0.3 ms a frame are 47 frames; the rest of the way decays by 1 / 20 to
// 1 / 40 a frame.
TEST(PidFrameRateTest, LocksFromEitherSideWithinItsRateLimitAndStays) {
  for (const double phase_ms : {14.0, 16.5}) {
    FakeRig rig(1);
    const FakeCamera& camera = rig.add(0, {.phase = from_ms(phase_ms), .rate_ppm = 30});
    rig.run(*make_alignment("pid_frame_rate"), from_ms(40'000));
    for (const FakeControl& control : nonempty(camera.controls())) {
      EXPECT_EQ(control.kind, FrameControlKind::kFrameLength);
      EXPECT_LE(std::chrono::abs(control.value - kSlot), from_ms(0.3) + from_us(1));
    }
    EXPECT_EQ(std::chrono::abs(camera.controls()[0].value - kSlot), from_ms(0.3));
    EXPECT_GT(largest_slot_error(camera, 40 * kSlot), from_ms(1));
    EXPECT_LT(largest_slot_error(camera, from_ms(20'000)), from_us(3))
        << "the sum takes out the rate of the camera's oscillator";
    EXPECT_TRUE(rig.host(0).last_report(0).aligned);
  }
}

// Critically damped, and the sum stands still at the limit: hardly beyond the slot.
TEST(PidFrameRateTest, TheSumDoesNotWindUp) {
  FakeRig rig(1);
  const FakeCamera& camera = rig.add(0, {.phase = from_ms(14)});
  rig.run(*make_alignment("pid_frame_rate"), from_ms(20'000));
  Nanoseconds earliest{};
  for (const Nanoseconds middle : nonempty(camera.middles())) {
    earliest = std::min(earliest, phase_error(middle, kSlot));
  }
  EXPECT_GT(earliest, from_ms(-1.5)) << "a tenth of the way";
}

// A rate of 10 ppm is 0.3 us a frame, of which the camera can make steps of 13 us only.
TEST(PidFrameRateTest, WhatRoundingLeavesIsCarriedOn) {
  FakeRig rig(1);
  FakeCameraScript coarse{.phase = from_ms(2), .rate_ppm = 10};
  coarse.limits.granularity = from_us(13);
  const FakeCamera& camera = rig.add(0, coarse);
  rig.run(*make_alignment("pid_frame_rate"), from_ms(40'000));
  EXPECT_LT(largest_slot_error(camera, from_ms(20'000)), from_us(2 * 13));
}

TEST(PidFrameRateTest, LostControlsAreRepeated) {
  FakeRig rig(2);
  rig.world().host(1).offset = from_ms(4);
  rig.add(0, {.phase = from_ms(14)});
  const FakeCamera& camera = rig.add(
      1, {.phase = from_ms(14), .is_lost = [](std::size_t number) { return number % 4 == 0; }});
  rig.run(*make_alignment("pid_frame_rate"), from_ms(20'000));
  EXPECT_LT(std::chrono::abs(phase_error(camera.middles().back() + from_ms(4), kSlot)),
            from_us(20));
  EXPECT_TRUE(rig.host(1).last_report(1).aligned);
  EXPECT_TRUE(rig.host(0).last_report(0).aligned);
}

TEST(PidFrameRateTest, WhatItCannotSteerIsReported) {
  FakeRig rig(1);
  FakeCameraScript unable{.phase = from_ms(14)};
  unable.limits.allowed = {true, true, false, true};
  rig.add(0, unable);
  FakeCameraScript full_rate{.phase = from_ms(14)};
  full_rate.limits.shortest = kSlot;
  rig.add(0, full_rate);
  rig.run(*make_alignment("pid_frame_rate"), from_ms(5000));
  EXPECT_THAT(rig.host(0).last_report(0).message, HasSubstr("frame_length"));
  EXPECT_THAT(rig.host(0).last_report(1).message, HasSubstr("allowed: between 30.0"));
  EXPECT_FALSE(rig.host(0).last_report(0).aligned);
  EXPECT_FALSE(rig.host(0).last_report(1).aligned);
  EXPECT_EQ(rig.world().unfinished(), 0u);
}

}  // namespace
}  // namespace simbench
