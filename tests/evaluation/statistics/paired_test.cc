#include "evaluation/statistics/paired.h"

#include <gmock/gmock.h>

#include <boost/random/lognormal_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <functional>
#include <limits>

namespace simbench::evaluation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// a = 10, 10.2, 9.8, ... and b = f(a).
PairedValues pairs_of(std::size_t count, const std::function<double(std::size_t, double)>& f) {
  PairedValues values;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = 10 + 0.2 * static_cast<double>(i % 3) - 0.2;
    values.pairs.push_back({a, f(i, a)});
  }
  return values;
}

TEST(PairUp, LeavesOutAndCountsWhatDoesNotExist) {
  const PairedValues values = pair_up({1, kNaN, 3, kNaN, 5}, {2, 2, kNaN, kNaN, 7});
  ASSERT_EQ(values.pairs.size(), 2U);
  EXPECT_EQ(values.pairs[1].a, 5);
  EXPECT_EQ(values.pairs[1].b, 7);
  EXPECT_EQ(values.left_out, 3U);
}

TEST(Compare, EqualValuesAreNoDifference) {
  const PairedComparison c = compare(pairs_of(32, [](auto, double a) { return a; }), {});
  EXPECT_EQ(c.verdict, Verdict::kNoDifferenceSeen);
  EXPECT_EQ(c.difference.low, 0);
  EXPECT_EQ(c.difference.high, 0);
  EXPECT_EQ(c.ratio.low, 1);
  EXPECT_EQ(c.ratio.high, 1);
}

TEST(Compare, AFactorIsFoundExactly) {
  const PairedComparison c = compare(pairs_of(30, [](auto, double a) { return a / 4; }), {});
  EXPECT_EQ(c.verdict, Verdict::kBetter);
  EXPECT_FALSE(c.within_effect);
  EXPECT_NEAR(c.ratio.value, 0.25, 1e-12);
  EXPECT_NEAR(c.ratio.low, 0.25, 1e-12);
  EXPECT_NEAR(c.ratio.high, 0.25, 1e-12);
  EXPECT_NEAR(c.difference.value, -7.5, 1e-12);
  EXPECT_NEAR(c.mean_a, 10, 1e-12);
  EXPECT_NEAR(c.median_b, 2.5, 1e-12);
}

TEST(Compare, AConstantDifferenceHasNoWidth) {
  const PairedComparison c = compare(pairs_of(32, [](auto, double) { return 10.5; }), {});
  EXPECT_LT(c.difference.low, c.difference.high);  // b is constant, a is not
  const PairedComparison shifted =
      compare({.pairs = std::vector<Pair>(32, {10, 10.5})}, {.higher_is_better = true});
  EXPECT_EQ(shifted.difference.low, 0.5);
  EXPECT_EQ(shifted.difference.high, 0.5);
  EXPECT_EQ(shifted.verdict, Verdict::kBetter);
}

TEST(Compare, WhichDirectionIsBetterIsTheRules) {
  const PairedValues higher = pairs_of(32, [](auto, double a) { return a + 3; });
  EXPECT_EQ(compare(higher, {}).verdict, Verdict::kWorse);
  EXPECT_EQ(compare(higher, {.higher_is_better = true}).verdict, Verdict::kBetter);
}

TEST(Compare, ASureButSmallDifferenceIsCalledSo) {
  const PairedComparison c = compare(pairs_of(32, [](auto, double a) { return a * 1.01; }), {});
  EXPECT_EQ(c.verdict, Verdict::kWorse);
  EXPECT_TRUE(c.within_effect);
}

// Differences of +-s in turn: their mean is 0, its interval about +-2 s / sqrt(n).
PairedComparison scattered(std::size_t pairs, double scatter, const ComparisonRule& rule = {}) {
  return compare(
      pairs_of(pairs, [=](auto i, double a) { return a + (i % 2 == 0 ? scatter : -scatter); }),
      rule);
}

TEST(Compare, TheSmallestEffectDividesNoDifferenceFromTooFewSeeds) {
  EXPECT_EQ(scattered(32, 0.5).verdict, Verdict::kNoDifferenceSeen);
  EXPECT_EQ(scattered(32, 5).verdict, Verdict::kTooFewSeeds);
  EXPECT_EQ(scattered(32, 5, {.smallest_effect = 0.5}).verdict, Verdict::kNoDifferenceSeen);
  EXPECT_EQ(scattered(32, 5, {.smallest_step = 5}).verdict, Verdict::kNoDifferenceSeen);
  EXPECT_NEAR(scattered(32, 5).smallest_effect, 0.05 * 10, 0.01);
}

// Width 2 * 1.96 s / sqrt(N) = 0.5 for s = 5 gives N = 1537.
TEST(Compare, TheSeedsNeededAreThoseThatMakeTheIntervalNarrowEnough) {
  const PairedComparison c = scattered(64, 5);
  ASSERT_EQ(c.verdict, Verdict::kTooFewSeeds);
  EXPECT_NEAR(static_cast<double>(c.seeds_needed), 1537, 250);
  const PairedComparison enough = scattered(c.seeds_needed + 2, 5);
  EXPECT_EQ(enough.verdict, Verdict::kNoDifferenceSeen);
  EXPECT_NEAR(static_cast<double>(scattered(4, 5).seeds_needed), 1537 * 4. / 3, 150);
}

TEST(Compare, TooFewPairsHaveNoInterval) {
  for (const std::size_t pairs : {1U, 2U, 5U}) {
    const PairedComparison c = compare(pairs_of(pairs, [](auto, double a) { return 2 * a; }), {});
    EXPECT_EQ(c.verdict, Verdict::kTooFewSeeds);
    EXPECT_TRUE(std::isnan(c.difference.low));
    EXPECT_NEAR(c.ratio.value, 2, 1e-12);
    EXPECT_EQ(c.seeds_needed, pairs == 1 ? 0 : kFewestPairs);
  }
  EXPECT_EQ(compare(pairs_of(6, [](auto, double a) { return 2 * a; }), {}).verdict,
            Verdict::kWorse);
}

TEST(Compare, OfNoPairsNothingIsKnown) {
  const PairedComparison c = compare(pair_up({kNaN, kNaN}, {1, 2}), {});
  EXPECT_EQ(c.verdict, Verdict::kTooFewSeeds);
  EXPECT_TRUE(std::isnan(c.mean_a) && std::isnan(c.ratio.value) && std::isnan(c.difference.value));
  EXPECT_EQ(c.left_out, 2U);
  EXPECT_EQ(c.seeds_needed, 0U);
}

TEST(Compare, ARatioToNothingDoesNotExist) {
  const PairedComparison c = compare({.pairs = std::vector<Pair>(32, {0, 1})}, {});
  EXPECT_TRUE(std::isnan(c.ratio.value) && std::isnan(c.ratio.low));
  EXPECT_EQ(c.verdict, Verdict::kWorse);
  // Only one pair of A is not 0: some resamples lack it.
  PairedValues rare{.pairs = std::vector<Pair>(32, {0, 1})};
  rare.pairs[3].a = 8;
  EXPECT_TRUE(std::isnan(compare(rare, {}).ratio.low));
}

TEST(Compare, OrderOfArgumentsOnlyTurnsTheSign) {
  PairedValues values =
      pairs_of(40, [](auto i, double a) { return a + 0.1 * static_cast<double>(i % 7); });
  const PairedComparison forth = compare(values, {});
  for (Pair& pair : values.pairs) std::swap(pair.a, pair.b);
  const PairedComparison back = compare(values, {});
  EXPECT_NEAR(forth.difference.low, -back.difference.high, 0.01);
  EXPECT_NEAR(forth.ratio.value * back.ratio.value, 1, 1e-12);
}

// How often the interval holds the true mean, of 95 % promised, over `experiments` samples.
template <typename Distribution>
double coverage(std::size_t pairs, Distribution distribution, double mean, int experiments) {
  boost::random::mt19937_64 random(7);
  int held = 0;
  for (int i = 0; i < experiments; ++i) {
    PairedValues values;
    for (std::size_t k = 0; k < pairs; ++k) values.pairs.push_back({1, 1 + distribution(random)});
    const Estimate difference = compare(values, {}).difference;
    held += static_cast<int>(difference.low <= mean && mean <= difference.high);
  }
  return 100.0 * held / experiments;
}

TEST(Compare, TheIntervalHoldsTheMeanAboutAsOftenAsItSays) {
  const boost::random::normal_distribution<double> normal(0.3, 1);
  EXPECT_NEAR(coverage(8, normal, 0.3, 1000), 95, 2.5);
  EXPECT_NEAR(coverage(32, normal, 0.3, 1000), 95, 2.5);
  // Skewed as errors are: e^N(0, 0.5) with mean e^0.125.
  const boost::random::lognormal_distribution<double> skewed(0, 0.5);
  EXPECT_NEAR(coverage(32, skewed, std::exp(0.125), 1000), 95, 3.5);
}

}  // namespace
}  // namespace simbench::evaluation
