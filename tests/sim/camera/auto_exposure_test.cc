#include "sim/camera/auto_exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kExposureSeed = 5;

AutoExposureLoop stepping(std::size_t camera = 0) {
  return {{.step_interval_exponential_ms = 200, .min_ms = 2, .max_ms = 6},
          from_ms(8),
          kExposureSeed,
          camera,
          at_ms(1000)};
}

TEST(AutoExposureLoop, WithoutStepsIsConstant) {
  AutoExposureLoop exposure({.step_interval_exponential_ms = 0, .min_ms = 1, .max_ms = 2},
                            from_ms(8), kExposureSeed, 0, at_ms(0));
  for (const double ms : {-1.0, 0.0, 1e9}) EXPECT_EQ(exposure.at(at_ms(ms)), from_ms(8)) << ms;
}

TEST(AutoExposureLoop, BeginsWithTheConfiguredExposureAndGoesToValuesOfItsRange) {
  AutoExposureLoop exposure = stepping();
  EXPECT_EQ(exposure.at(at_ms(0)), from_ms(8));
  EXPECT_EQ(exposure.at(at_ms(1000)), from_ms(8));
  int steps = 0;
  double sum_ms = 0;
  Nanoseconds last = from_ms(8);
  constexpr int kSeconds = 2000;
  for (int ms = 1000; ms < 1000 + 1000 * kSeconds; ++ms) {
    const Nanoseconds now = exposure.at(at_ms(ms));
    if (now == last) continue;
    ++steps;
    last = now;
    sum_ms += to_ms(now);
    EXPECT_GE(now, from_ms(2));
    EXPECT_LE(now, from_ms(6));
  }
  // 5 steps a second, Poisson: 10,000 +- 100; of those closer than the 1 ms of the scan, about
  // 1 ms / 200 ms, two are seen as one.
  EXPECT_NEAR(steps, 10'000 * (1 - 0.0025), 5 * 100) << "seed " << kExposureSeed;
  EXPECT_NEAR(sum_ms / steps, 4, 5 * 4 / std::sqrt(12.0 * 10'000)) << "seed " << kExposureSeed;
}

TEST(AutoExposureLoop, ValuesDoNotDependOnTheOrderOfQueries) {
  AutoExposureLoop forwards = stepping();
  AutoExposureLoop backwards = stepping();
  std::vector<Nanoseconds> seen;
  seen.reserve(500);
  for (int i = 0; i < 500; ++i) seen.push_back(forwards.at(at_ms(37.0 * i)));
  for (int i = 499; i >= 0; --i) EXPECT_EQ(backwards.at(at_ms(37.0 * i)), seen.at(i)) << i;
}

TEST(AutoExposureLoop, EveryCameraHasItsOwnSteps) {
  AutoExposureLoop one = stepping(0);
  AutoExposureLoop other = stepping(1);
  EXPECT_NE(one.at(at_ms(9000)), other.at(at_ms(9000)));
}

}  // namespace
}  // namespace simbench::sim
