#include <gmock/gmock.h>

#include "tests/algorithms/capture_alignment/fake_camera.h"

namespace simbench {
namespace {

using ::testing::HasSubstr;

constexpr Nanoseconds kPhonePeriod = from_ms(30);
constexpr Nanoseconds kGoal = from_ms(15);

Nanoseconds last_phase(const FakeCamera& camera) { return camera.middles().back() % kPhonePeriod; }

// A phase 4 ms before the goal, and one 4 ms behind it, which needs the rest of a period.
TEST(LibsoftwaresyncTest, WhereTwoFramesAreStretchedOneIterationIsEnough) {
  for (const double phase_ms : {11.0, 19.0}) {
    FakeRig rig(1);
    const FakeCamera& camera = rig.add(0, {.phase = from_ms(phase_ms), .stretched_per_insert = 2});
    rig.run(*make_alignment("libsoftwaresync"), from_ms(6000));
    ASSERT_EQ(camera.controls().size(), 1u);
    EXPECT_EQ(camera.controls()[0].kind, FrameControlKind::kInsertFrame);
    EXPECT_EQ(camera.controls()[0].value, from_ms(phase_ms < 15 ? 32 : 43));
    EXPECT_GE(camera.controls()[0].at, from_ms(2000));
    EXPECT_LE(camera.controls()[0].at, from_ms(2000) + 2 * kPhonePeriod);
    EXPECT_EQ(last_phase(camera), kGoal);
    EXPECT_TRUE(rig.host(0).last_report(0).aligned);
    EXPECT_EQ(rig.host(0).last_report(0).controls, 1u);
    EXPECT_EQ(rig.world().unfinished(), 0u) << "nothing holds the phase afterwards";
  }
}

// 3.2 ms to go, halved each time: 1.6, 0.8, 0.4 left; then d / 2 is 0.2 ms, below the least of
// 0.25 ms that an inserted frame moves: 0.15 left; and 0.25 ms more is 0.1 too far.
TEST(LibsoftwaresyncTest, WhereOneFrameIsStretchedEachIterationHalvesWhatIsLeft) {
  FakeRig rig(1);
  const FakeCamera& camera = rig.add(0, {.phase = from_ms(11.8)});
  rig.run(*make_alignment("libsoftwaresync"), from_ms(6000));
  ASSERT_EQ(camera.controls().size(), 5u);
  const double expected_ms[] = {31.6, 30.8, 30.4, 30.25, 30.25};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(camera.controls()[i].value, from_ms(expected_ms[i])) << i;
    if (i == 0) continue;
    const Nanoseconds pause = camera.controls()[i].at - camera.controls()[i - 1].at;
    EXPECT_GE(pause, from_ms(400));
    EXPECT_LE(pause, from_ms(400) + 2 * kPhonePeriod);
  }
  EXPECT_EQ(last_phase(camera), from_ms(15.1));
  const AlignmentReport report = rig.host(0).last_report(0);
  EXPECT_FALSE(report.aligned) << "the threshold itself is not aligned";
  EXPECT_THAT(report.message, HasSubstr("after 5 inserted frames"));
}

TEST(LibsoftwaresyncTest, ThereTheWholeShiftNeedsOneIteration) {
  FakeRig rig(1);
  const FakeCamera& camera = rig.add(0, {.phase = from_ms(11.8)});
  rig.run(*make_alignment("libsoftwaresync", {{"share_of_shift", 1.0}}), from_ms(6000));
  ASSERT_EQ(camera.controls().size(), 1u);
  EXPECT_EQ(camera.controls()[0].value, from_ms(33.2));
  EXPECT_EQ(last_phase(camera), kGoal);
}

TEST(LibsoftwaresyncTest, AllCamerasMoveToTheGoalOfTheirHostsSystemClock) {
  FakeRig rig(3);
  rig.world().host(2).offset = from_ms(4);
  const FakeCamera& first = rig.add(0, {.phase = from_ms(3), .stretched_per_insert = 2});
  const FakeCamera& second = rig.add(0, {.phase = from_ms(29), .stretched_per_insert = 2});
  const FakeCamera& third = rig.add(2, {.phase = from_ms(9), .stretched_per_insert = 2});
  rig.run(*make_alignment("libsoftwaresync", {{"threshold_ms", 0.2}}), from_ms(6000));
  EXPECT_EQ(last_phase(first), kGoal);
  EXPECT_EQ(last_phase(second), kGoal);
  EXPECT_EQ(last_phase(third), kGoal - from_ms(4));
}

TEST(LibsoftwaresyncTest, ALostFrameCostsAnIteration) {
  FakeRig rig(1);
  const FakeCamera& camera = rig.add(0, {.phase = from_ms(11),
                                         .stretched_per_insert = 2,
                                         .is_lost = [](std::size_t number) { return number < 2; }});
  rig.run(*make_alignment("libsoftwaresync"), from_ms(6000));
  EXPECT_EQ(camera.controls().size(), 3u);
  EXPECT_EQ(last_phase(camera), kGoal);
  EXPECT_TRUE(rig.host(0).last_report(0).aligned);
}

TEST(LibsoftwaresyncTest, ARefusedFrameIsReported) {
  FakeRig rig(1);
  FakeCameraScript unable{.phase = from_ms(11)};
  unable.limits.allowed = {true, false, true, true};
  rig.add(0, unable);
  FakeCameraScript small{.phase = from_ms(20)};
  small.limits.longest = from_ms(40);  // 42.5 ms are wanted
  rig.add(0, small);
  rig.run(*make_alignment("libsoftwaresync"), from_ms(6000));
  EXPECT_FALSE(rig.host(0).last_report(0).aligned);
  EXPECT_THAT(rig.host(0).last_report(0).message, HasSubstr("insert_frame"));
  EXPECT_FALSE(rig.host(0).last_report(1).aligned);
  EXPECT_THAT(rig.host(0).last_report(1).message, HasSubstr("42.5"));
  EXPECT_EQ(rig.host(0).reports().size(), 2u);
}

// A period of the configuration that is 20 us short: the goal walks by that much each frame.
TEST(LibsoftwaresyncTest, TheConfiguredPeriodCountsWhereThereIsOne) {
  FakeRig rig(1);
  const FakeCamera& camera = rig.add(0, {.phase = from_ms(1), .stretched_per_insert = 2});
  rig.run(*make_alignment("libsoftwaresync", {{"period_ms", 29.98}}), from_ms(2100));
  ASSERT_EQ(camera.controls().size(), 1u);
  const Nanoseconds sent = camera.controls()[0].at;
  const Nanoseconds middle = sent - from_ms(5 + 8);  // of the latest frame
  const Nanoseconds wanted = kGoal - middle % from_ms(29.98);
  EXPECT_EQ(camera.controls()[0].value, from_ms(29.98) + wanted / 2);
}

}  // namespace
}  // namespace simbench
