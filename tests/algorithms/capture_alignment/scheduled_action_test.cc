#include <gmock/gmock.h>

#include "tests/algorithms/capture_alignment/fake_camera.h"

namespace simbench {
namespace {

using ::testing::HasSubstr;

constexpr Nanoseconds kHalfExposure = from_ms(5);

// Asked at 0: at the next whole second and one more.
TEST(ScheduledActionTest, AllCamerasStartAtTheSameTimeOfTheirSystemClocks) {
  FakeRig rig(2);
  rig.world().host(1).offset = from_ms(-250);
  const FakeCamera& first = rig.add(0, {.phase = from_ms(3)});
  const FakeCamera& second = rig.add(0, {.phase = from_ms(17), .stamps_steady = false});
  const FakeCamera& third = rig.add(1, {.phase = from_ms(29)});
  rig.run(*make_alignment("scheduled_action"), from_ms(6000));
  for (const FakeCamera* camera : {&first, &second, &third}) {
    ASSERT_EQ(camera->controls().size(), 1u) << camera->camera();
    EXPECT_EQ(camera->controls()[0].kind, FrameControlKind::kStartAt);
    const PeerId host = camera == &third ? 1 : 0;
    // The clock of the second host is still in the second before 0.
    EXPECT_EQ(camera->controls()[0].value, from_ms(host == 0 ? 2000 : 1000));
    const Nanoseconds start = camera->controls()[0].value - rig.world().host(host).offset;
    EXPECT_EQ((camera->middles().back() - start - kHalfExposure) % from_ms(30), Nanoseconds(0));
    EXPECT_TRUE(rig.host(host).last_report(camera->camera()).aligned);
  }
  EXPECT_EQ(rig.world().unfinished(), 0u) << "free run afterwards";
}

TEST(ScheduledActionTest, ALostStartIsRepeatedThreeTimesInAll) {
  for (const std::size_t lost : {1, 3}) {
    FakeRig rig(1);
    const FakeCamera& camera =
        rig.add(0, {.phase = from_ms(3), .is_lost = [lost](std::size_t n) { return n < lost; }});
    rig.run(*make_alignment("scheduled_action"), from_ms(20'000));
    EXPECT_EQ(camera.controls().size(), lost == 1 ? 2u : 3u);
    const AlignmentReport report = rig.host(0).last_report(0);
    EXPECT_EQ(report.aligned, lost == 1);
    EXPECT_EQ(report.message.empty(), lost == 1);
  }
}

TEST(ScheduledActionTest, RepeatedStartsTakeOutTheDrift) {
  FakeRig rig(1);
  const FakeCamera& camera = rig.add(0, {.phase = from_ms(3), .rate_ppm = 20});
  rig.run(*make_alignment("scheduled_action", {{"repeat_s", 4.0}}), from_ms(29'000));
  ASSERT_GE(camera.controls().size(), 4u);
  for (std::size_t i = 1; i < camera.controls().size(); ++i) {
    EXPECT_EQ(camera.controls()[i].value % from_ms(1000), Nanoseconds(0));
    EXPECT_GE(camera.controls()[i].at - camera.controls()[i - 1].at, from_ms(4000));
  }
  const Nanoseconds since = camera.middles().back() - camera.controls().back().value;
  const Nanoseconds drift = (since - kHalfExposure) % from_ms(30);
  EXPECT_LE(drift, from_us(20 * 6)) << "at most 6 s since the last start";
  EXPECT_EQ(rig.host(0).last_report(0).controls, camera.controls().size());
}

TEST(ScheduledActionTest, ACameraWithoutTheControlIsReportedOnce) {
  FakeRig rig(1);
  FakeCameraScript unable{.phase = from_ms(3)};
  unable.limits.allowed = {true, true, true, false};
  rig.add(0, unable);
  rig.add(0, {.phase = from_ms(3)});
  rig.run(*make_alignment("scheduled_action", {{"repeat_s", 1.0}}), from_ms(5000));
  EXPECT_FALSE(rig.host(0).last_report(0).aligned);
  EXPECT_THAT(rig.host(0).last_report(0).message, HasSubstr("start_at"));
  EXPECT_EQ(rig.host(0).last_report(0).controls, 0u);
  EXPECT_TRUE(rig.host(0).last_report(1).aligned);
}

}  // namespace
}  // namespace simbench
