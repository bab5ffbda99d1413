#include "evaluation/scoring/pulse_spread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace simbench::evaluation {
namespace {

constexpr std::int64_t kMs = 1'000'000;

double deviation(const std::vector<std::int64_t>& stamps, MedianKind kind) {
  std::vector<std::int64_t> workspace;
  return differences_from_median(stamps, kind, workspace).deviation_ms;
}

// `low` stamps at zero, the others at one second.
std::vector<std::int64_t> step(std::size_t n, std::size_t low) {
  std::vector<std::int64_t> stamps(n, 1000 * kMs);
  std::fill_n(stamps.begin(), low, 0);
  return stamps;
}

TEST(MetricsTest, SpreadIsLargestMinusSmallest) {
  EXPECT_DOUBLE_EQ(spread_ms(std::vector<std::int64_t>{5 * kMs, -2 * kMs, 1 * kMs}), 7);
  EXPECT_DOUBLE_EQ(spread_ms(std::vector<std::int64_t>{5}), 0);
}

TEST(MetricsTest, DeviationOfAnOddNumberIsAboutTheMiddle) {
  const std::vector<std::int64_t> stamps = {4 * kMs, 0, 1 * kMs};
  EXPECT_DOUBLE_EQ(deviation(stamps, MedianKind::kUpperMiddle), std::sqrt(10.0 / 3));
  EXPECT_DOUBLE_EQ(deviation(stamps, MedianKind::kMeanOfMiddleTwo), std::sqrt(10.0 / 3));
}

TEST(MetricsTest, DeviationOfAnEvenNumberDependsOnTheMedian) {
  const std::vector<std::int64_t> stamps = {9 * kMs, 2 * kMs, 0, 4 * kMs};
  // About 4: 25 + 4 + 16 + 0. About 3: 36 + 1 + 9 + 1.
  EXPECT_DOUBLE_EQ(deviation(stamps, MedianKind::kUpperMiddle), std::sqrt(45.0 / 4));
  EXPECT_DOUBLE_EQ(deviation(stamps, MedianKind::kMeanOfMiddleTwo), std::sqrt(47.0 / 4));
}

TEST(MetricsTest, StampsOfAnyEpochAreExact) {
  constexpr std::int64_t kUnixEpochNs = 1'700'000'000'000'000'000;
  const std::vector<std::int64_t> small = {0, 1, 3, 4};
  std::vector<std::int64_t> large = small;
  for (std::int64_t& stamp : large) stamp += kUnixEpochNs;
  EXPECT_EQ(spread_ms(large), spread_ms(small));
  for (const MedianKind kind : {MedianKind::kUpperMiddle, MedianKind::kMeanOfMiddleTwo}) {
    EXPECT_EQ(deviation(large, kind), deviation(small, kind));
  }
}

TEST(MetricsTest, BoundsOfThePaper) {
  EXPECT_DOUBLE_EQ(rmdv_bound(18, MedianKind::kUpperMiddle), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(rmdv_bound(18, MedianKind::kMeanOfMiddleTwo), 2.0 / 3);
  EXPECT_DOUBLE_EQ(rmdv_bound(6, MedianKind::kUpperMiddle), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(rmdv_bound(1, MedianKind::kUpperMiddle), 0);
}

TEST(MetricsTest, StepsAttainTheBoundAndNoneExceedsIt) {
  for (const MedianKind kind : {MedianKind::kUpperMiddle, MedianKind::kMeanOfMiddleTwo}) {
    for (std::size_t n = 2; n <= 24; ++n) {
      double largest = 0;
      for (std::size_t low = 0; low <= n; ++low) {
        const std::vector<std::int64_t> stamps = step(n, low);
        largest = std::max(largest, deviation(stamps, kind) / 1000);
      }
      EXPECT_NEAR(largest, rmdv_bound(n, kind), 1e-12) << "n = " << n;
    }
  }
}

double mean_difference(const std::vector<std::int64_t>& stamps, MedianKind kind) {
  std::vector<std::int64_t> workspace;
  return differences_from_median(stamps, kind, workspace).mean_ms;
}

TEST(PrintedRmdvTest, TheRadicandIsTheMeanLessTheMedian) {
  const std::vector<std::int64_t> stamps = {9 * kMs, 2 * kMs, 0, 4 * kMs};  // mean 3.75
  EXPECT_DOUBLE_EQ(mean_difference(stamps, MedianKind::kUpperMiddle), -0.25);
  EXPECT_DOUBLE_EQ(mean_difference(stamps, MedianKind::kMeanOfMiddleTwo), 0.75);
}

// docs/reference/paper.md section 6: at most (8/18) of the range, at 10 stamps low and 8 high.
TEST(PrintedRmdvTest, StepsAttainItsBounds) {
  for (std::size_t n = 2; n <= 24; n += 2) {
    double least = 0;
    double largest = 0;
    for (std::size_t low = 0; low <= n; ++low) {
      const double radicand = mean_difference(step(n, low), MedianKind::kUpperMiddle) / 1000;
      least = std::min(least, radicand);
      largest = std::max(largest, radicand);
    }
    EXPECT_DOUBLE_EQ(least, -0.5) << "n = " << n;
    EXPECT_DOUBLE_EQ(largest, (static_cast<double>(n) / 2 - 1) / static_cast<double>(n))
        << "n = " << n;
  }
}

TEST(PrintedRmdvTest, APulseWithoutARealRootIsLeftOutAndCounted) {
  PrintedRmdv printed;
  EXPECT_TRUE(std::isnan(printed.mean_sqrt_ms()));
  EXPECT_TRUE(std::isnan(printed.real_share()));
  printed.add({.mean_ms = -4});
  EXPECT_TRUE(std::isnan(printed.mean_sqrt_ms()));
  EXPECT_DOUBLE_EQ(printed.real_share(), 0);
  printed.add({.mean_ms = 4});
  printed.add({.mean_ms = 0});
  printed.add({.mean_ms = 9});
  EXPECT_DOUBLE_EQ(printed.mean_sqrt_ms(), (2.0 + 0 + 3) / 3);
  EXPECT_DOUBLE_EQ(printed.real_share(), 0.75);
}

TEST(MetricsTest, RmdvNeverExceedsTheBoundTimesAmd) {
  for (std::uint32_t seed = 1; seed <= 2000; ++seed) {
    std::mt19937 random(seed);
    const std::size_t n = 2 + random() % 30;
    // From a few levels, so that clusters and steps are common, or from anywhere.
    const std::uint64_t levels = seed % 2 == 0 ? 2 + random() % 3 : 1'000'000'000;
    std::vector<std::int64_t> stamps(n);
    for (std::int64_t& stamp : stamps) stamp = static_cast<std::int64_t>(random() % levels);
    for (const MedianKind kind : {MedianKind::kUpperMiddle, MedianKind::kMeanOfMiddleTwo}) {
      EXPECT_LE(deviation(stamps, kind), rmdv_bound(n, kind) * spread_ms(stamps) * (1 + 1e-12))
          << "seed " << seed << ", n = " << n;
    }
  }
}

}  // namespace
}  // namespace simbench::evaluation
