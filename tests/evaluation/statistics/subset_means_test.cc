#include "evaluation/statistics/subset_means.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <vector>

namespace simbench::evaluation {
namespace {

std::vector<Pair> with_differences(const std::vector<double>& differences) {
  std::vector<Pair> pairs;
  pairs.reserve(differences.size());
  for (const double each : differences) pairs.push_back({10, 10 + each});
  return pairs;
}

// The means of the subsets of {1, 2, 4} are 1, 2, 4, 1.5, 2.5, 3, 7/3.
TEST(SubsetMeans, AreAllOfAFewPairs) {
  const SubsetMeans means(with_differences({1, 2, 4}), 12);
  EXPECT_DOUBLE_EQ(means.p(), 2. / 8);  // no mean is up to 0
  const Estimate widest = means.difference(0.25);
  EXPECT_DOUBLE_EQ(widest.value, 7. / 3);
  EXPECT_DOUBLE_EQ(widest.low, 1);
  EXPECT_DOUBLE_EQ(widest.high, 4);
  EXPECT_DOUBLE_EQ(means.difference(0.5).low, 1.5);
  EXPECT_DOUBLE_EQ(means.difference(0.5).high, 3);
  EXPECT_TRUE(std::isnan(means.difference(0.24).low));
}

// Signs of {3, -1, -1, -1}: the sum is 0 or beyond in half of the cases, so p is 1.
TEST(SubsetMeans, TiesCountOnBothSides) {
  EXPECT_DOUBLE_EQ(SubsetMeans(with_differences({0.3, -0.1, -0.1, -0.1}), 12).p(), 1);
  EXPECT_DOUBLE_EQ(SubsetMeans(with_differences({0.1, -0.1}), 12).p(), 1);
  EXPECT_DOUBLE_EQ(SubsetMeans(with_differences({0.7}), 12).p(), 1);
}

// One zero among six equal signs: it doubles every count, as if it were not there.
TEST(SubsetMeans, AnEqualPairSaysNothing) {
  EXPECT_DOUBLE_EQ(SubsetMeans(with_differences({1, 1, 1, 1, 1}), 12).p(), 2. / 32);
  EXPECT_DOUBLE_EQ(SubsetMeans(with_differences({1, 1, 1, 1, 1, 0}), 12).p(), 4. / 64);
}

TEST(SubsetMeans, DrawnSubsetsStandForAll) {
  boost::random::mt19937_64 random(3);
  boost::random::normal_distribution<double> normal(0.4, 1);
  std::vector<Pair> pairs;
  pairs.reserve(16);
  for (int i = 0; i < 16; ++i) pairs.push_back({20, 20 + normal(random)});
  const SubsetMeans all(pairs, 16);
  const SubsetMeans drawn(pairs, 14);
  EXPECT_NEAR(drawn.p(), all.p(), 0.3 * all.p() + 0.002);
  EXPECT_NEAR(drawn.difference(0.05).low, all.difference(0.05).low, 0.05);
  EXPECT_NEAR(drawn.ratio(0.05).high, all.ratio(0.05).high, 0.003);
}

TEST(SubsetMeans, MorePairsThanAMaskHasBits) {
  std::vector<Pair> pairs;
  pairs.reserve(130);
  for (int i = 0; i < 130; ++i) pairs.push_back({1, i % 2 == 0 ? 2 : 1.5});
  const SubsetMeans means(pairs, 12);
  EXPECT_DOUBLE_EQ(means.p(), 2. / 4096);
  // Deviation 0.25, sqrt(130) pairs: 1.96 * 0.0220 on either side.
  EXPECT_NEAR(means.difference(0.05).low, 0.75 - 0.043, 0.004);
  EXPECT_NEAR(means.difference(0.05).high, 0.75 + 0.043, 0.004);
}

// How often, in percent, the interval holds `truth` over `experiments` samples of pairs.
template <typename Draw, typename Choose>
double coverage(int experiments, std::size_t pairs, double error, double truth, const Draw& draw,
                const Choose& choose) {
  boost::random::mt19937_64 random(7);
  int held = 0;
  for (int i = 0; i < experiments; ++i) {
    std::vector<Pair> sample(pairs);
    for (Pair& pair : sample) pair = draw(random);
    const Estimate interval = choose(SubsetMeans(sample, 12), error);
    held += interval.low <= truth && truth <= interval.high ? 1 : 0;
  }
  return 100.0 * held / experiments;
}

Estimate of_difference(const SubsetMeans& means, double error) { return means.difference(error); }
Estimate of_ratio(const SubsetMeans& means, double error) { return means.ratio(error); }

constexpr int kExperiments = 2000;
constexpr double kFourSigma = 2;  // percent points of 2000 experiments at 95 %

// Exact for symmetric differences of any tail, here of a normal, of Cauchy's law, which has no
// mean at all, and of two equal skewed draws.
TEST(SubsetMeansCoverage, IsExactForSymmetricDifferences) {
  boost::random::normal_distribution<double> normal;
  const auto light = [&](auto& random) { return Pair{0, 0.3 + normal(random)}; };
  const auto heavy = [&](auto& random) {
    const double above = normal(random);
    return Pair{0, 0.3 + above / normal(random)};
  };
  const auto equal = [&](auto& random) {
    return Pair{std::exp(2 * normal(random)), std::exp(2 * normal(random))};
  };
  for (const std::size_t pairs : {8U, 12U, 32U}) {
    EXPECT_NEAR(coverage(kExperiments, pairs, 0.05, 0.3, light, of_difference), 95.3, kFourSigma);
    EXPECT_NEAR(coverage(kExperiments, pairs, 0.05, 0.3, heavy, of_difference), 95.3, kFourSigma);
    EXPECT_NEAR(coverage(kExperiments, pairs, 0.05, 0, equal, of_difference), 95.3, kFourSigma);
  }
  // At the level of one of ten verdicts.
  EXPECT_NEAR(coverage(kExperiments, 12, 0.005, 0.3, heavy, of_difference), 99.5, 0.6);
}

// Differences of two values only, as of a recall that is 1 or 0: never less often than stated.
TEST(SubsetMeansCoverage, IsSafeForTwoValues) {
  const auto coin = [](auto& random) { return Pair{0, random() % 2 == 0 ? 1.0 : -1.0}; };
  for (const std::size_t pairs : {6U, 8U, 16U}) {
    EXPECT_GE(coverage(kExperiments, pairs, 0.05, 0, coin, of_difference), 95 - kFourSigma / 2);
  }
}

// Skewed differences are held less often, the more so the fewer they are: e^N(0, 0.5) and the ratio
// of such values with a common factor, as worlds have one.
TEST(SubsetMeansCoverage, OfSkewedDifferencesIsALittleBelow) {
  boost::random::normal_distribution<double> normal;
  const auto skewed = [&](auto& random) { return Pair{0, std::exp(0.5 * normal(random))}; };
  EXPECT_NEAR(coverage(kExperiments, 12, 0.05, std::exp(0.125), skewed, of_difference), 92.5, 2.5);
  EXPECT_NEAR(coverage(kExperiments, 32, 0.05, std::exp(0.125), skewed, of_difference), 94, 2);
  const auto ratio = [&](auto& random) {
    const double world = std::exp(0.5 * normal(random));
    return Pair{world * std::exp(0.2 * normal(random)), 3 * world * std::exp(0.2 * normal(random))};
  };
  EXPECT_NEAR(coverage(kExperiments, 32, 0.05, 3, ratio, of_ratio), 95, 2);
}

}  // namespace
}  // namespace simbench::evaluation
