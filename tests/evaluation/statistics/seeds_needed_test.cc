#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

// 0, 1/n, ..., 1: the quantiles of a uniform distribution.
std::vector<double> uniform(int n) {
  std::vector<double> values;
  for (int i = 0; i <= n; ++i) values.push_back(static_cast<double>(i) / n);
  return values;
}

// The 95 % interval of one uniform draw is [0.025, 0.975]; the median of three is Beta(2, 2), whose
// distribution 3 x^2 - 2 x^3 is 0.025 at 0.0943.
TEST(SeedsNeeded, UniformDraws) {
  const std::vector<double> values = uniform(10'000);
  EXPECT_NEAR(median_interval(values, 1).low, 0.025, 1e-9);
  EXPECT_NEAR(median_interval(values, 1).high, 0.975, 1e-9);
  EXPECT_NEAR(median_interval(values, 1).relative, 0.95, 1e-9);
  const double low = median_interval(values, 3).low;
  EXPECT_NEAR(3 * low * low - 2 * low * low * low, 0.025, 1e-4);
}

// For many seeds the median is normal with sigma 1 / (2 f sqrt(n)), here 1 / (2 sqrt(n)).
TEST(SeedsNeeded, ManySeedsGoByTheNormalDistribution) {
  const MedianInterval interval = median_interval(uniform(100'000), 10'000);
  EXPECT_NEAR(interval.high - interval.low, 2 * 1.96 / (2 * std::sqrt(10'000)), 1e-4);
}

TEST(SeedsNeeded, TheFewestThatAreEnough) {
  const std::vector<double> values = uniform(10'000);
  for (const double wanted : {0.5, 0.2, 0.05}) {
    const auto seeds = seeds_for(values, wanted);
    ASSERT_TRUE(seeds);
    EXPECT_LE(median_interval(values, *seeds).relative, wanted);
    EXPECT_GT(median_interval(values, *seeds - 1).relative, wanted);
  }
}

// What the interval promises, tried: 95 % of studies with 16 seeds lie within it.
TEST(SeedsNeeded, HoldsForDrawsFromTheRun) {
  std::mt19937 random(3);
  std::vector<double> values;
  values.reserve(999);
  for (int i = 0; i < 999; ++i) {
    values.push_back(std::exp(static_cast<double>(random()) / 4294967296.0 * 4));
  }
  const MedianInterval interval = median_interval(values, 16);
  int inside = 0;
  constexpr int kStudies = 4000;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> drawn;
    drawn.reserve(16);
    for (int i = 0; i < 16; ++i) drawn.push_back(values[random() % values.size()]);
    const double centre = median(drawn);
    inside += centre >= interval.low && centre <= interval.high ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inside) / kStudies, 0.95, 0.03);
}

TEST(SeedsNeeded, NothingToGoBy) {
  EXPECT_TRUE(std::isnan(median_interval({}, 8).relative));
  EXPECT_FALSE(seeds_for({}, 0.1));
  EXPECT_TRUE(std::isnan(median_interval({0, 0, 0}, 8).relative));
  EXPECT_EQ(seeds_for({5, 5, 5}, 0.02), 1);
}

}  // namespace
}  // namespace simbench::evaluation
