#include <gmock/gmock.h>

#include <algorithm>

#include "algorithms/capture_alignment/steered_camera.h"
#include "tests/algorithms/capture_alignment/fake_camera.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

using ::testing::HasSubstr;

constexpr Nanoseconds kGridPeriod = from_ms(30);

Nanoseconds largest_error_since(const FakeCamera& camera, Nanoseconds since) {
  Nanoseconds largest{};
  for (const Nanoseconds middle : nonempty(camera.middles())) {
    if (middle < since) continue;
    largest = std::max(largest, std::chrono::abs(phase_error(middle, kGridPeriod)));
  }
  return largest;
}

// With frames of 20 to 100 ms.
TEST(PeriodicPtpTest, TheWholeErrorIsTakenOffOneFrameInTheShorterWay) {
  struct Case {
    Nanoseconds phase;
    Nanoseconds longer;
  };
  for (const Case& each : {Case{from_ms(7), from_ms(-7)},      // later would be 23 ms
                           Case{from_ms(20), from_ms(10)},     // earlier would be two frames
                           Case{from_ms(12), from_ms(18)}}) {  // likewise
    FakeRig rig(1);
    const FakeCamera& camera = rig.add(0, {.phase = each.phase});
    rig.run(*make_alignment("periodic_ptp"), from_ms(2000));
    ASSERT_EQ(camera.controls().size(), 1u);
    EXPECT_EQ(camera.controls()[0].kind, FrameControlKind::kAdjustFrame);
    EXPECT_EQ(camera.controls()[0].value, each.longer);
    EXPECT_EQ(phase_error(camera.middles().back(), kGridPeriod), Nanoseconds(0));
    const AlignmentReport report = rig.host(0).last_report(0);
    EXPECT_TRUE(report.aligned);
    EXPECT_EQ(report.controls, 1u);
    EXPECT_EQ(report.message, "");
  }
}

TEST(PeriodicPtpTest, TheGridIsOfTheHostsSystemClockAndAllCamerasShareIt) {
  FakeRig rig(3);
  rig.world().host(2).offset = from_ms(4);
  const FakeCamera& first = rig.add(0, {.phase = from_ms(3)});
  const FakeCamera& second = rig.add(0, {.phase = from_ms(29)});
  const FakeCamera& third = rig.add(1, {.phase = from_ms(11), .stamps_steady = false});
  const FakeCamera& fourth = rig.add(2, {.phase = from_ms(14)});
  rig.run(*make_alignment("periodic_ptp"), from_ms(3000));
  EXPECT_EQ(phase_error(first.middles().back(), kGridPeriod), Nanoseconds(0));
  EXPECT_EQ(phase_error(second.middles().back(), kGridPeriod), Nanoseconds(0));
  // By the arrivals, which are half of the exposure and the delay later.
  const Nanoseconds late = from_ms(5) + from_ms(8);
  EXPECT_LE(std::chrono::abs(phase_error(third.middles().back() + late, kGridPeriod)), from_us(2));
  EXPECT_EQ(phase_error(fourth.middles().back() + from_ms(4), kGridPeriod), Nanoseconds(0));
}

TEST(PeriodicPtpTest, ARateErrorIsCorrectedWithOneControlAtATime) {
  FakeRig rig(1);
  const FakeCamera& camera = rig.add(0, {.phase = from_ms(7), .rate_ppm = 50});
  rig.run(*make_alignment("periodic_ptp"), from_ms(20'000));
  // 1.5 us a frame, over the at most 8 frames from one control's effect to the next's.
  EXPECT_LE(largest_error_since(camera, from_ms(1000)), from_us(12));
  ASSERT_GT(camera.controls().size(), 50u);
  for (std::size_t i = 1; i < camera.controls().size(); ++i) {
    EXPECT_GT(camera.controls()[i].at - camera.controls()[i - 1].at, 4 * kGridPeriod) << i;
  }
  EXPECT_TRUE(rig.host(0).last_report(0).aligned);
  EXPECT_LE(rig.host(0).reports().size(), 22u) << "mere counts come once a second";
}

TEST(PeriodicPtpTest, ALostControlIsRepeated) {
  FakeRig rig(1);
  const FakeCamera& camera =
      rig.add(0, {.phase = from_ms(7), .is_lost = [](std::size_t number) { return number < 2; }});
  rig.run(*make_alignment("periodic_ptp"), from_ms(2000));
  ASSERT_EQ(camera.controls().size(), 3u);
  for (const FakeControl& control : camera.controls()) EXPECT_EQ(control.value, from_ms(-7));
  EXPECT_EQ(phase_error(camera.middles().back(), kGridPeriod), Nanoseconds(0));
}

TEST(PeriodicPtpTest, BelowHalfAGranuleNothingIsSent) {
  FakeRig rig(1);
  FakeCameraScript coarse{.phase = from_us(9)};
  coarse.limits.granularity = from_us(20);
  const FakeCamera& camera = rig.add(0, coarse);
  rig.run(*make_alignment("periodic_ptp"), from_ms(2000));
  EXPECT_TRUE(camera.controls().empty());
  EXPECT_TRUE(rig.host(0).last_report(0).aligned);
}

TEST(PeriodicPtpTest, ACameraWithoutTheControlIsReportedOnceAndLeftAlone) {
  FakeRig rig(1);
  FakeCameraScript unable{.phase = from_ms(7)};
  unable.limits.allowed = {false, true, true, true};
  rig.add(0, unable);
  const FakeCamera& able = rig.add(0, {.phase = from_ms(7)});
  rig.run(*make_alignment("periodic_ptp"), from_ms(2000));
  const AlignmentReport report = rig.host(0).last_report(0);
  EXPECT_FALSE(report.aligned);
  EXPECT_EQ(report.controls, 0u);
  EXPECT_THAT(report.message, HasSubstr("adjust_frame"));
  EXPECT_TRUE(rig.host(0).last_report(1).aligned);
  EXPECT_EQ(able.controls().size(), 1u);
}

TEST(PeriodicPtpTest, AGridThatTheFramesCannotReachIsReported) {
  FakeRig rig(1);
  FakeCameraScript fast;
  fast.limits.shortest = from_ms(31);
  const FakeCamera& camera = rig.add(0, fast);
  rig.run(*make_alignment("periodic_ptp"), from_ms(1000));
  EXPECT_EQ(rig.world().unfinished(), 0u);
  EXPECT_FALSE(rig.host(0).last_report(0).aligned);
  EXPECT_THAT(rig.host(0).last_report(0).message, HasSubstr("allowed: from 31.0"));
  EXPECT_TRUE(camera.controls().empty());
}

TEST(PeriodicPtpTest, ASilentCameraIsReported) {
  FakeRig rig(1);
  rig.add(0, {.phase = from_ms(7), .stops_at = from_ms(1000)});
  rig.run(*make_alignment("periodic_ptp"), from_ms(20'000));
  EXPECT_FALSE(rig.host(0).last_report(0).aligned);
  EXPECT_THAT(rig.host(0).last_report(0).message, HasSubstr("no frame came"));
  EXPECT_EQ(rig.host(0).reports().size(), 3u);
}

}  // namespace
}  // namespace simbench
