#include "evaluation/diagnosis/spread_budget.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "tests/evaluation/diagnosis/clocked_rig.h"

namespace simbench::evaluation {
namespace {

using ::testing::IsNan;

double budget_wave_s(double now_s) { return 0.8e-3 * std::sin(2 * std::numbers::pi * now_s / 6); }

SpreadBudget budget_of_seed(std::uint32_t seed) {
  const ClockRigCamera one{.name = "a",
                           .host = "A",
                           .error_s = budget_wave_s,
                           .phase_ms = 2.5,
                           .delivery_sd_ms = 0.4,
                           .stamp_sd_ms = 0.15,
                           .seed = seed};
  const ClockRigCamera other{.name = "b",
                             .host = "B",
                             .delivery_sd_ms = 0.3,
                             .stamp_sd_ms = 0.2,
                             .clock_ppm = -30,
                             .seed = seed};
  const auto a = camera_delays(rig_recording(one));
  const auto b = camera_delays(rig_recording(other));
  return *spread_budget({*a, budget_wave_s, {}}, {*b, keeps_time, {}});
}

bool interval_holds(const SpreadPart& part, double truth_ms) {
  return part.low_ms <= truth_ms && truth_ms <= part.high_ms;
}

TEST(SpreadBudget, KnownPartsAreWithinTheirIntervals) {
  constexpr int kSeeds = 100;
  int stamp = 0;
  int delivery = 0;
  int clock = 0;
  int constant = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const SpreadBudget budget = budget_of_seed(seed);
    stamp += interval_holds(budget.stamp, std::hypot(0.15, 0.2)) ? 1 : 0;
    delivery += interval_holds(budget.delivery, std::hypot(0.4, 0.3)) ? 1 : 0;
    clock += interval_holds(budget.host_clock, 0.8 / std::numbers::sqrt2) ? 1 : 0;
    constant += interval_holds(budget.constant, 2.5) ? 1 : 0;
    EXPECT_LT(budget.unexplained.low_ms, 0.05);
  }
  EXPECT_GE(stamp, 90);
  EXPECT_GE(delivery, 90);
  EXPECT_GE(clock, 90);
  EXPECT_GE(constant, 90);
}

TEST(SpreadBudget, SharesAddUpToOne) {
  const SpreadBudget budget = budget_of_seed(1);
  const double sum = budget.stamp.share + budget.delivery.share + budget.host_clock.share +
                     budget.constant.share + budget.unexplained.share;
  EXPECT_NEAR(sum, 1, 1e-6);
  const double total_square = budget.total.rms_ms * budget.total.rms_ms;
  EXPECT_NEAR(budget.constant.share, 2.5 * 2.5 / total_square, 0.02);
  EXPECT_THAT(budget.exposure.rms_ms, IsNan());
}

TEST(SpreadBudget, WithoutALogTheClockIsUnexplained) {
  const auto a = camera_delays(rig_recording({.name = "a", .host = "A", .error_s = budget_wave_s}));
  const auto b = camera_delays(rig_recording({.name = "b", .host = "B"}));
  const auto budget = spread_budget({*a, {}, {}}, {*b, {}, {}});
  ASSERT_TRUE(budget);
  EXPECT_THAT(budget->host_clock.rms_ms, IsNan());
  // A block of 2.75 s has most of a wave of 6 s as its line.
  EXPECT_GT(budget->unexplained.rms_ms, 0.4);
}

TEST(SpreadBudget, ExposuresAreSubtractedWhereTheyAreKnown) {
  RecordedStream late = rig_recording({.name = "a"});
  std::vector<double> longer_ms;
  for (std::size_t i = 0; i < late.frames.size(); ++i) {
    longer_ms.push_back(8 + 3 * std::sin(static_cast<double>(i) / 40));
    late.frames[i].arrival += from_ms(longer_ms.back() - 8);
  }
  const std::vector<double> constant_ms(late.frames.size(), 8);
  const auto a = camera_delays(late);
  const auto b = camera_delays(rig_recording({.name = "b"}));
  const auto budget = spread_budget({*a, {}, longer_ms}, {*b, {}, constant_ms});
  ASSERT_TRUE(budget);
  EXPECT_NEAR(budget->exposure.rms_ms, 3 / std::numbers::sqrt2, 0.1);
  EXPECT_NEAR(budget->delivery.rms_ms, 0.1 * std::numbers::sqrt2, 0.02);
  EXPECT_NEAR(budget->host_clock.rms_ms, 0, 1e-12);
}

TEST(SpreadBudget, HostsFarApartArePairedByTheirLogs) {
  const ClockErrorS ahead = [](double) { return 0.25; };
  const auto a =
      camera_delays(rig_recording({.name = "a", .host = "A", .error_s = ahead, .phase_ms = -1}));
  const auto b = camera_delays(rig_recording({.name = "b", .host = "B"}));
  const auto budget = spread_budget({*a, ahead, {}}, {*b, keeps_time, {}});
  ASSERT_TRUE(budget);
  EXPECT_NEAR(budget->host_clock.rms_ms, 250, 1e-6);
  EXPECT_NEAR(budget->constant_ms, -1, 0.02);
}

TEST(SpreadBudget, StampsFrom1970TellTheExposures) {
  RecordedStream one = rig_recording({.name = "a", .host = "A", .phase_ms = 5.2, .delay_ms = 20});
  RecordedStream other = rig_recording({.name = "b", .host = "B"});
  for (StampedFrame& frame : one.frames) frame.sensor += from_seconds(kRigDayS);
  for (StampedFrame& frame : other.frames) frame.sensor += from_seconds(kRigDayS);
  const auto a = camera_delays(one);
  const auto b = camera_delays(other);
  const auto budget = spread_budget({*a, {}, {}}, {*b, {}, {}});
  ASSERT_TRUE(budget);
  EXPECT_NEAR(budget->stamps_apart_ms, 5.2, 0.05);
  EXPECT_NEAR(budget->constant_ms, 16.2, 0.1);
}

TEST(SpreadBudget, CamerasThatShareNoTimeHaveNone) {
  const auto a = camera_delays(rig_recording({.name = "a"}));
  const auto b = camera_delays(rig_recording({.name = "b", .start_s = 500}));
  EXPECT_FALSE(spread_budget({*a, {}, {}}, {*b, {}, {}}));
}

}  // namespace
}  // namespace simbench::evaluation
