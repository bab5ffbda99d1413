#include <gmock/gmock.h>

#include <algorithm>
#include <utility>

#include "algorithms/capture_alignment/steered_camera.h"
#include "tests/algorithms/capture_alignment/fake_camera.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

constexpr Nanoseconds kLinePeriod = from_ms(30);

// A phone: later frames only, by inserting one, which stretches so many.
FakeCameraScript phone(Nanoseconds phase, int stretched_per_insert, double rate_ppm = 0) {
  FakeCameraScript script{
      .phase = phase, .rate_ppm = rate_ppm, .stretched_per_insert = stretched_per_insert};
  script.limits.shortest = script.limits.frame_length;
  script.limits.allowed = {false, true, false, false};
  return script;
}

// The least and the most by which a camera's exposures since then are later than the grid, but for
// those that a control is just moving.
std::pair<Nanoseconds, Nanoseconds> errors_since(const FakeCamera& camera, Nanoseconds since,
                                                 Nanoseconds grid_phase) {
  Nanoseconds least = kLinePeriod;
  Nanoseconds most = -kLinePeriod;
  for (const Nanoseconds middle : nonempty(camera.middles())) {
    const bool is_moving = std::ranges::any_of(camera.controls(), [&](const FakeControl& control) {
      return middle > control.at && middle < control.at + 8 * kLinePeriod;
    });
    if (middle < since || is_moving) continue;
    const Nanoseconds error = phase_error(middle - grid_phase, kLinePeriod);
    least = std::min(least, error);
    most = std::max(most, error);
  }
  return {least, most};
}

TEST(PhaseRateTest, TheMastersFirstCameraStaysAndTheOthersComeToIt) {
  FakeRig rig(3);
  rig.world().host(2).offset = from_ms(4);
  const FakeCamera& first = rig.add(0, {.phase = from_ms(3)});
  const FakeCamera& second = rig.add(0, {.phase = from_ms(20)});
  const FakeCamera& third = rig.add(1, {.phase = from_ms(29)});
  const FakeCamera& fourth = rig.add(2, {.phase = from_ms(14)});
  rig.run(*make_alignment("phase_rate"), from_ms(5000));
  EXPECT_TRUE(first.controls().empty());
  for (const FakeCamera* camera : {&second, &third}) {
    EXPECT_EQ(camera->controls().size(), 1u);
    EXPECT_LE(std::chrono::abs(phase_error(camera->middles().back() - from_ms(3), kLinePeriod)),
              from_us(1));
  }
  EXPECT_LE(std::chrono::abs(phase_error(fourth.middles().back() + from_ms(1), kLinePeriod)),
            from_us(1))
      << "its host's clock is 4 ms ahead";
  EXPECT_TRUE(rig.host(2).last_report(3).aligned);
}

TEST(PhaseRateTest, WhereTheMasterHasNoCameraMultiplesOfThePeriodAreTheGrid) {
  FakeRig rig(2);
  const FakeCamera& camera = rig.add(1, {.phase = from_ms(7)});
  rig.run(*make_alignment("phase_rate"), from_ms(5000));
  EXPECT_LE(std::chrono::abs(phase_error(camera.middles().back(), kLinePeriod)), from_us(1));
}

TEST(PhaseRateTest, AMasterWhoseCameraIsSilentHoldsNobodyUp) {
  FakeRig rig(2);
  rig.add(0, {.phase = from_ms(3), .stops_at = from_ms(50)});
  const FakeCamera& camera = rig.add(1, {.phase = from_ms(7)});
  rig.run(*make_alignment("phase_rate"), from_ms(10'000));
  EXPECT_LE(std::chrono::abs(phase_error(camera.middles().back(), kLinePeriod)), from_us(1));
}

// 1.5 us a frame against the grid: a granule or two at a time, before they are due. But for the
// first, no frame is disturbed: longer or shorter by 1 %.
TEST(PhaseRateTest, ARateErrorIsForetoldAndCorrectedByGranules) {
  FakeRig rig(2);
  rig.add(0, {.phase = from_ms(3)});
  const FakeCamera& camera = rig.add(1, {.phase = from_ms(10), .rate_ppm = 50});
  rig.run(*make_alignment("phase_rate"), from_ms(20'000));
  const auto [least, most] = errors_since(camera, from_ms(5000), from_ms(3));
  EXPECT_GE(least, from_us(-3));
  EXPECT_LE(most, from_us(3));
  std::size_t disturbed = 0;
  for (const FakeControl& control : nonempty(camera.controls())) {
    if (std::chrono::abs(control.value) > from_us(300)) ++disturbed;
  }
  EXPECT_EQ(disturbed, 1u);
}

TEST(PhaseRateTest, ALostControlShowsInTheStampsAndIsRepeated) {
  FakeRig rig(2);
  rig.add(0, {.phase = from_ms(3)});
  const FakeCamera& camera =
      rig.add(1, {.phase = from_ms(7), .is_lost = [](std::size_t number) { return number < 2; }});
  rig.run(*make_alignment("phase_rate"), from_ms(10'000));
  EXPECT_EQ(camera.controls().size(), 3u);
  EXPECT_LE(std::chrono::abs(phase_error(camera.middles().back() - from_ms(3), kLinePeriod)),
            from_us(1));
}

// With a band of 0.1 ms and a rate of 20 ppm it is put 100 us ahead, which is half of what it
// drifts in 10 s, and goes on until it is 200 us late: some 15 s. The next ones last as long.
TEST(PhaseRateTest, WhereFramesCanOnlyBeInsertedOneLastsAsLongAsItCan) {
  FakeRig rig(2);
  rig.add(0, phone(from_ms(3), 2));
  const FakeCamera& camera = rig.add(1, phone(from_ms(9), 2, 20));
  rig.run(*make_alignment("phase_rate", {{"insert_band_ms", 0.1}}), from_ms(40'000));
  ASSERT_EQ(camera.controls().size(), 3u);
  EXPECT_NEAR(to_ms(camera.controls()[2].at - camera.controls()[1].at), 15'000, 200);
  const auto [least, most] = errors_since(camera, from_ms(4000), from_ms(3));
  EXPECT_GE(least, from_us(-102));
  EXPECT_LE(most, from_us(203));
  EXPECT_EQ(camera.controls()[0].kind, FrameControlKind::kInsertFrame);
}

// The first one moves by half of what it should; from then on that is known.
TEST(PhaseRateTest, HowFarAnInsertedFrameMovesIsLearned) {
  FakeRig rig(2);
  rig.add(0, phone(from_ms(3), 1));
  const FakeCamera& camera = rig.add(1, phone(from_ms(9), 1));
  rig.run(*make_alignment("phase_rate"), from_ms(10'000));
  ASSERT_EQ(camera.controls().size(), 2u);
  EXPECT_EQ(camera.controls()[0].value, from_ms(42));  // 24 ms later, halved
  EXPECT_NEAR(to_ms(camera.controls()[1].value), 42, 0.01);
  EXPECT_LE(std::chrono::abs(phase_error(camera.middles().back() - from_ms(3), kLinePeriod)),
            from_us(10));
}

TEST(PhaseRateTest, AGridThatTheFramesCannotReachIsReported) {
  FakeRig rig(2);
  rig.add(0, {.phase = from_ms(3)});
  FakeCameraScript slow{.phase = from_ms(7)};
  slow.limits.shortest = from_ms(31);
  const FakeCamera& camera = rig.add(1, slow);
  rig.run(*make_alignment("phase_rate"), from_ms(3000));
  EXPECT_TRUE(camera.controls().empty());
  EXPECT_FALSE(rig.host(1).last_report(1).aligned);
  EXPECT_FALSE(rig.host(1).last_report(1).message.empty());
}

}  // namespace
}  // namespace simbench
