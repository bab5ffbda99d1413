#include "evaluation/statistics/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace simbench::evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::IsNan;

// P(X >= k) of a binomial distribution, summed term by term.
double upper_tail(std::int64_t k, std::int64_t n, double p) {
  double sum = 0;
  for (std::int64_t i = k; i <= n; ++i) {
    const double log_ways = std::lgamma(static_cast<double>(n + 1)) -
                            std::lgamma(static_cast<double>(i + 1)) -
                            std::lgamma(static_cast<double>(n - i + 1));
    sum += std::exp(log_ways + static_cast<double>(i) * std::log(p) +
                    static_cast<double>(n - i) * std::log1p(-p));
  }
  return sum;
}

TEST(QuantileTest, InterpolatesBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0), 1);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 1), 4);
  EXPECT_DOUBLE_EQ(quantile({10, 20, 30}, 0.25), 15);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.05), 7);
}

TEST(QuantileTest, OfASeriesIsTheQuantileOfItsValues) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    std::vector<double> values(1 + random() % 50);
    for (double& value : values) value = static_cast<double>(random() % 100);
    const Series series = make_series(values);
    EXPECT_DOUBLE_EQ(series.p05, quantile(values, 0.05)) << "seed " << seed;
    EXPECT_DOUBLE_EQ(series.median, quantile(values, 0.5)) << "seed " << seed;
    EXPECT_DOUBLE_EQ(series.p95, quantile(values, 0.95)) << "seed " << seed;
  }
}

TEST(SeriesTest, KeepsTheOrderAndLeavesNanOutOfTheBand) {
  const Series series = make_series({3, kNan, 1, 2});
  EXPECT_THAT(series.values, ElementsAre(3, IsNan(), 1, 2));
  EXPECT_DOUBLE_EQ(series.median, 2);
  EXPECT_DOUBLE_EQ(series.p05, 1.1);
  EXPECT_DOUBLE_EQ(series.p95, 2.9);
}

TEST(SeriesTest, OfNothingIsNan) {
  for (const Series& series : {make_series({}), make_series({kNan})}) {
    EXPECT_THAT(series.median, IsNan());
    EXPECT_THAT(series.p05, IsNan());
    EXPECT_THAT(series.p95, IsNan());
  }
  EXPECT_THAT(quantile({kNan}, 0.5), IsNan());
}

TEST(BinomialIntervalTest, WithoutSuccessHasAClosedForm) {
  const Interval interval = binomial_interval(0, 32);
  EXPECT_DOUBLE_EQ(interval.low, 0);
  EXPECT_NEAR(interval.high, 1 - std::pow(0.025, 1.0 / 32), 1e-12);
  EXPECT_NEAR(interval.high, 0.1089, 5e-5);
  const Interval mirrored = binomial_interval(32, 32);
  EXPECT_NEAR(mirrored.low, 1 - interval.high, 1e-12);
  EXPECT_DOUBLE_EQ(mirrored.high, 1);
}

// Published tables of Clopper and Pearson's limits.
TEST(BinomialIntervalTest, AgreesWithTables) {
  EXPECT_NEAR(binomial_interval(16, 32).low, 0.3189, 5e-5);
  EXPECT_NEAR(binomial_interval(16, 32).high, 0.6811, 5e-5);
  EXPECT_NEAR(binomial_interval(1, 10).low, 0.0025, 5e-5);
  EXPECT_NEAR(binomial_interval(1, 10).high, 0.4450, 5e-5);
  EXPECT_NEAR(binomial_interval(5, 10).low, 0.1871, 5e-5);
  EXPECT_NEAR(binomial_interval(5, 10).high, 0.8129, 5e-5);
}

TEST(BinomialIntervalTest, LeavesATailOnEachSide) {
  for (const std::int64_t trials : {8, 32, 100}) {
    for (std::int64_t successes = 1; successes < trials; ++successes) {
      const Interval interval = binomial_interval(successes, trials);
      EXPECT_NEAR(upper_tail(successes, trials, interval.low), 0.025, 1e-9);
      EXPECT_NEAR(1 - upper_tail(successes + 1, trials, interval.high), 0.025, 1e-9);
    }
  }
}

TEST(BinomialIntervalTest, OfNoTrialsIsEverything) {
  EXPECT_DOUBLE_EQ(binomial_interval(0, 0).low, 0);
  EXPECT_DOUBLE_EQ(binomial_interval(0, 0).high, 1);
}

TEST(PercentileTest, CountsValuesBelow) {
  const Percentile percentile = percentile_of(2.5, {1, 2, 3, kNan, 4});
  EXPECT_DOUBLE_EQ(percentile.percent, 50);
  EXPECT_DOUBLE_EQ(percentile.low, 100 * binomial_interval(2, 4).low);
  EXPECT_DOUBLE_EQ(percentile.high, 100 * binomial_interval(2, 4).high);
}

TEST(PercentileTest, EqualValuesCountHalf) {
  const Percentile percentile = percentile_of(2, {1, 2, 3, 4});
  EXPECT_DOUBLE_EQ(percentile.percent, 37.5);
  EXPECT_DOUBLE_EQ(percentile.low, 100 * binomial_interval(1, 4).low);
  EXPECT_DOUBLE_EQ(percentile.high, 100 * binomial_interval(2, 4).high);
}

TEST(PercentileTest, AmongNoValuesIsNan) {
  EXPECT_THAT(percentile_of(1, {kNan}).percent, IsNan());
  EXPECT_THAT(percentile_of(1, {}).low, IsNan());
}

TEST(PercentileTest, OfABoundCountsEqualValuesAsKept) {
  const Percentile below = percent_at_most(2, {1, 2, 3, 4, kNan});
  EXPECT_DOUBLE_EQ(below.percent, 50);
  EXPECT_DOUBLE_EQ(below.low, 100 * binomial_interval(2, 4).low);
  EXPECT_DOUBLE_EQ(below.high, 100 * binomial_interval(2, 4).high);
  EXPECT_DOUBLE_EQ(percent_at_least(2, {1, 2, 3, 4, kNan}).percent, 75);
  EXPECT_DOUBLE_EQ(percent_at_least(-2, {-1, -3}).percent, 50);
  EXPECT_THAT(percent_at_most(2, {kNan}).percent, IsNan());
  EXPECT_THAT(percent_at_least(2, {}).low, IsNan());
}

// n values, k of them below the published one.
Placement placement_among(int n, int k) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) values.push_back(i < k ? 1 : 3);
  return placement_of(percentile_of(2, values));
}

TEST(PlacementTest, FollowsFromTheIntervalOfThePercentile) {
  EXPECT_EQ(placement_of({.percent = 50, .low = 5, .high = 95}), Placement::kInside);
  EXPECT_EQ(placement_of({.percent = 50, .low = 4.9, .high = 95}), Placement::kTooFewSeeds);
  EXPECT_EQ(placement_of({.percent = 50, .low = 5, .high = 95.1}), Placement::kTooFewSeeds);
  EXPECT_EQ(placement_of({.percent = 2, .low = 0, .high = 4.9}), Placement::kOutside);
  EXPECT_EQ(placement_of({.percent = 97, .low = 95.1, .high = 100}), Placement::kOutside);
  EXPECT_EQ(placement_of(percentile_of(1, {})), Placement::kTooFewSeeds);
}

TEST(PlacementTest, NeedsSeeds) {
  for (int below = 0; below <= 2; ++below) {
    EXPECT_EQ(placement_among(2, below), Placement::kTooFewSeeds) << below;
  }
  EXPECT_EQ(placement_among(3, 1), Placement::kTooFewSeeds);
  EXPECT_EQ(placement_among(4, 2), Placement::kInside);
  EXPECT_EQ(placement_among(kFewestOutside - 1, 0), Placement::kTooFewSeeds);
  EXPECT_EQ(placement_among(kFewestOutside, 0), Placement::kOutside);
  EXPECT_EQ(placement_among(kFewestOutside, kFewestOutside), Placement::kOutside);
}

TEST(MedianTime, NeverIsLaterThanAllOthers) {
  EXPECT_EQ(median_time({3, 1, 2}), 2);
  EXPECT_EQ(median_time({1, 2, 3, 4}), 2.5);
  EXPECT_EQ(median_time({1, kNan, 3}), 3);
  EXPECT_TRUE(std::isnan(median_time({1, kNan})));
  EXPECT_TRUE(std::isnan(median_time({kNan, 1, kNan})));
  EXPECT_TRUE(std::isnan(median_time({})));
}

}  // namespace
}  // namespace simbench::evaluation
