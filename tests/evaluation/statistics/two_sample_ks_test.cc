#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

using ::testing::IsNan;

constexpr double kRounding = 1e-12;

TEST(TwoSampleKs, DistanceOfSmallSamples) {
  EXPECT_DOUBLE_EQ(ks_distance({1, 2, 3}, {1, 2, 3}), 0);
  EXPECT_DOUBLE_EQ(ks_distance({1, 2, 3}, {4, 5}), 1);
  EXPECT_DOUBLE_EQ(ks_distance({1, 2, 3}, {2, 3, 4}), 1.0 / 3);
  EXPECT_DOUBLE_EQ(ks_distance({3, 1}, {2}), 0.5);
  EXPECT_DOUBLE_EQ(ks_distance({1, 2, 3, 4}, {2.5}), 0.5);
}

TEST(TwoSampleKs, EqualValuesStepTogether) {
  EXPECT_DOUBLE_EQ(ks_distance({1, 1, 1, 1}, {1}), 0);
  EXPECT_DOUBLE_EQ(ks_distance({1, 1, 2, 2}, {1, 2}), 0);
  EXPECT_DOUBLE_EQ(ks_distance({1, 1, 1, 2}, {1, 2, 2, 2}), 0.5);
}

TEST(TwoSampleKs, WithoutValuesThereIsNoDistance) {
  EXPECT_THAT(ks_distance({}, {1}), IsNan());
  EXPECT_THAT(ks_distance({1}, {kNan}), IsNan());
  EXPECT_DOUBLE_EQ(ks_distance({kNan, 1, kNan, 3}, {2, kNan}), 0.5);
}

// Two of the C(n + m, n) orders keep the samples apart altogether.
TEST(TwoSampleKs, ProbabilityOfNoOverlap) {
  EXPECT_NEAR(ks_probability(1, 1, 1), 1, kRounding);
  EXPECT_NEAR(ks_probability(3, 3, 1), 2.0 / 20, kRounding);
  EXPECT_NEAR(ks_probability(5, 5, 1), 2.0 / 252, kRounding);
  EXPECT_NEAR(ks_probability(4, 2, 1), 2.0 / 15, kRounding);
  EXPECT_NEAR(ks_probability(7, 9, 0), 1, kRounding);
}

// For equal sizes there is a closed form: the reflection principle gives
// P(D >= k / n) = 2 sum_i (-1)^(i + 1) C(2n, n + i k) / C(2n, n).
TEST(TwoSampleKs, ProbabilityFollowsTheClosedForm) {
  const auto log_choose = [](double n, double k) {
    return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
  };
  for (const int n : {2, 5, 10, 20, 60}) {
    for (int k = 1; k <= n; ++k) {
      double expected = 0;
      for (int i = 1; i * k <= n; ++i) {
        expected += (i % 2 == 1 ? 2 : -2) *
                    std::exp(log_choose(2.0 * n, n + i * k) - log_choose(2.0 * n, n));
      }
      const auto size = static_cast<std::size_t>(n);
      EXPECT_NEAR(ks_probability(size, size, static_cast<double>(k) / n), expected, 1e-9)
          << n << " " << k;
    }
  }
}

// The critical values of the tables in textbooks.
TEST(TwoSampleKs, CriticalDistances) {
  EXPECT_THAT(ks_critical_distance(3, 3), IsNan());
  EXPECT_DOUBLE_EQ(ks_critical_distance(4, 4), 1);
  EXPECT_DOUBLE_EQ(ks_critical_distance(5, 5), 1);
  EXPECT_DOUBLE_EQ(ks_critical_distance(10, 10), 0.7);
  EXPECT_DOUBLE_EQ(ks_critical_distance(20, 20), 0.45);
  EXPECT_THAT(ks_critical_distance(0, 5), IsNan());
}

TEST(TwoSampleKs, TheCriticalDistanceIsTheSmallestThatIsUnlikely) {
  for (std::size_t n = 2; n <= 12; ++n) {
    for (std::size_t m = 2; m <= 12; ++m) {
      const double critical = ks_critical_distance(n, m);
      if (std::isnan(critical)) {
        EXPECT_GT(ks_probability(n, m, 1), 0.05);
        continue;
      }
      EXPECT_LE(ks_probability(n, m, critical), 0.05) << n << " " << m;
      const double step = 1.0 / static_cast<double>(n * m);
      EXPECT_GT(ks_probability(n, m, critical - 1.5 * step * static_cast<double>(std::gcd(n, m))),
                0.05)
          << n << " " << m;
    }
  }
}

TEST(TwoSampleKs, LargeSamplesFollowTheAsymptoticLaw) {
  const double just_exact = ks_critical_distance(1000, 1000);
  EXPECT_NEAR(just_exact, 1.3581 * std::sqrt(2.0 / 1000), 0.001);
  EXPECT_NEAR(ks_critical_distance(1001, 1000), just_exact, 0.001);
}

// Samples of one distribution differ in at most 5 of 100 tests, and nearly so many do.
TEST(TwoSampleKs, RejectsAsOftenAsItSays) {
  constexpr unsigned kSeed = 1933;
  std::mt19937 random(kSeed);
  const double critical = ks_critical_distance(20, 30);
  int rejected = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<double> a;
    std::vector<double> b;
    a.reserve(20);
    b.reserve(30);
    for (int i = 0; i < 20; ++i) a.push_back(static_cast<double>(random()));
    for (int i = 0; i < 30; ++i) b.push_back(static_cast<double>(random()));
    if (ks_distance(a, b) >= critical) ++rejected;
  }
  EXPECT_NEAR(rejected, 4000 * ks_probability(20, 30, critical), 60) << "seed " << kSeed;
}

}  // namespace
}  // namespace simbench::evaluation
