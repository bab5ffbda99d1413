#include "algorithms/gathering/genlock_order.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <cstdint>

namespace simbench {
namespace {

using Variant = GenlockOrder::Variant;

constexpr double kRateHz = 45;
const Nanoseconds kNominalPeriod = from_ms(1000 / kRateHz);
// The trigger runs 500 ppm fast, the camera's clock 75 ppm slow.
constexpr double kStepUs = 1e6 / kRateHz / (1 + 500e-6) * (1 - 75e-6);

DeviceTime at_us(double us) { return DeviceTime(Microseconds(std::llround(us))); }

// The first frame whose index is wrong, or -1, when every frame of so many minutes is delivered.
std::int64_t first_wrong(Variant variant, double minutes) {
  GenlockOrder order(kNominalPeriod, variant);
  const auto frames = static_cast<std::int64_t>(minutes * 60 * kRateHz);
  for (std::int64_t i = 0; i < frames; ++i) {
    if (order.next(at_us(1e9 + static_cast<double>(i) * kStepUs)) != i) return i;
  }
  return -1;
}

TEST(GenlockOrder, CountsFromTheFirstFrame) {
  for (const Variant variant : {Variant::kReanchored, Variant::kFirstStamp}) {
    GenlockOrder order(from_ms(20), variant);
    EXPECT_EQ(order.next(at_us(123'456)), 0);
    EXPECT_EQ(order.next(at_us(143'456)), 1);
    EXPECT_EQ(order.next(at_us(203'456)), 4);  // two frames lost
    EXPECT_EQ(order.next(at_us(183'456)), 3);  // one of them, late
  }
}

TEST(GenlockOrder, RoundsToTheNearestPeriodOnBothSides) {
  for (const double shift_us : {-9'999.0, -1.0, 0.0, 1.0, 9'999.0}) {
    for (const std::int64_t periods : {-3, -1, 0, 1, 2, 1000}) {
      GenlockOrder order(from_ms(20), Variant::kFirstStamp);
      order.next(at_us(1e9));
      EXPECT_EQ(order.next(at_us(1e9 + static_cast<double>(periods) * 20'000 + shift_us)), periods)
          << periods << " periods and " << shift_us << " us";
    }
  }
}

TEST(GenlockOrder, HalfAPeriodCountsUpOnBothSides) {
  for (const std::int64_t period_us : {20'000, 20'001}) {
    for (std::int64_t elapsed_us = -3 * period_us; elapsed_us <= 3 * period_us; ++elapsed_us) {
      GenlockOrder order(Microseconds(period_us), Variant::kReanchored);
      order.next(DeviceTime{});
      const auto nearest = static_cast<std::int64_t>(std::floor(
          static_cast<double>(2 * elapsed_us + period_us) / static_cast<double>(2 * period_us)));
      ASSERT_EQ(order.next(DeviceTime(Microseconds(elapsed_us))), nearest)
          << elapsed_us << " us of a period of " << period_us;
    }
  }
}

TEST(GenlockOrder, PrintedVariantIsOffAfterHalfAPeriodOfDrift) {
  // 575 ppm reach half a period after 1 / (2 * 575e-6) = 870 frames: 19 s.
  const std::int64_t wrong = first_wrong(Variant::kFirstStamp, 10);
  EXPECT_NEAR(static_cast<double>(wrong), 870, 2);
  EXPECT_EQ(first_wrong(Variant::kFirstStamp, 0.3), -1);
}

TEST(GenlockOrder, ReanchoredHoldsForHours) {
  EXPECT_EQ(first_wrong(Variant::kReanchored, 180), -1);
}

TEST(GenlockOrder, ReanchoredSurvivesLossAndJitterUpToItsBound) {
  // Gaps up to 20 frames: 20 * 575 ppm = 0.0115 periods, so jitter up to 0.25 - 0.006 periods.
  constexpr std::uint32_t kSeed = 6;
  boost::random::mt19937 random(kSeed);
  const double bound_us = (0.25 - 0.006) * 1e6 / kRateHz;
  boost::random::uniform_real_distribution<double> jitter_us(-bound_us, bound_us);
  GenlockOrder order(kNominalPeriod, Variant::kReanchored);
  const double first_jitter_us = jitter_us(random);
  ASSERT_EQ(order.next(at_us(1e9 + first_jitter_us)), 0);
  std::int64_t pulse = 0;
  for (int i = 0; i < 100'000; ++i) {
    pulse += 1 + static_cast<std::int64_t>(random() % 20);
    const double us = 1e9 + static_cast<double>(pulse) * kStepUs + jitter_us(random);
    ASSERT_EQ(order.next(at_us(us)), pulse) << "seed " << kSeed;
  }
}

TEST(GenlockOrder, ReanchoredFailsBeyondItsBounds) {
  GenlockOrder jittered(from_ms(20), Variant::kReanchored);
  jittered.next(at_us(-5'100));                // a quarter of a period early and more,
  EXPECT_EQ(jittered.next(at_us(25'100)), 2);  // then as late: counted twice
  GenlockOrder paused(kNominalPeriod, Variant::kReanchored);
  paused.next(at_us(0));
  EXPECT_EQ(paused.next(at_us(900 * kStepUs)), 899);  // a gap beyond 1 / (2 * 575 ppm)
}

TEST(GenlockOrderDeathTest, PeriodMustBePositive) {
  EXPECT_DEATH(GenlockOrder(from_ms(0), Variant::kReanchored), "must be positive");
}

}  // namespace
}  // namespace simbench
