#include "evaluation/statistics/paired.h"

#include <gmock/gmock.h>

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

// One comparison alone.
PairedComparison compare(const PairedValues& values, const ComparisonRule& rule) {
  return compare_together({{.values = values, .rule = rule}}).front();
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
  // The deviation of four values is 5.77.
  EXPECT_NEAR(static_cast<double>(scattered(4, 5).seeds_needed), 1537 * 4. / 3, 150);
}

TEST(Compare, TooFewPairsHaveNoInterval) {
  for (const std::size_t pairs : {1U, 2U, 5U}) {
    const PairedComparison c = compare(pairs_of(pairs, [](auto, double a) { return 2 * a; }), {});
    EXPECT_EQ(c.verdict, Verdict::kTooFewSeeds);
    EXPECT_TRUE(std::isnan(c.difference.low));
    EXPECT_NEAR(c.ratio.value, 2, 1e-12);
    EXPECT_EQ(c.seeds_needed, pairs == 1 ? 0 : fewest_pairs(1));
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

// A large difference in a few seeds: what is missing is seeds for the test, not a million for
// the scatter.
TEST(Compare, ALargeDifferenceInFewSeedsNeedsFewMore) {
  const PairedValues values = pair_up({0.01, 0.03, 0.02, 0.015}, {1.2, 9.3, 2.5, 0.9});
  const PairedComparison c = compare(values, {});
  EXPECT_EQ(c.verdict, Verdict::kTooFewSeeds);
  EXPECT_EQ(c.higher, 4U);
  EXPECT_EQ(c.lower, 0U);
  EXPECT_NEAR(c.ratio.value, 13.9 / 0.075, 1e-9);
  EXPECT_EQ(c.p, 0.125);  // 2 / 2^4
  EXPECT_TRUE(std::isnan(c.difference.low));
  EXPECT_GE(c.seeds_needed, 6U);
  EXPECT_LE(c.seeds_needed, 12U);
}

TEST(FewestPairs, AreThoseWhosePValueCanBeSmallEnough) {
  EXPECT_EQ(fewest_pairs(1), 6U);    // 2 / 2^6 = 0.031
  EXPECT_EQ(fewest_pairs(2), 7U);    // 0.0156 for 0.025
  EXPECT_EQ(fewest_pairs(45), 11U);  // 0.00098 for 0.0011
}

TEST(CompareTogether, OneOfManyNeedsMorePairsThanOneAlone) {
  const auto doubled = [](auto i, double a) { return 2 * a + 0.01 * static_cast<double>(i); };
  std::vector<ComparisonTask> tasks(45, {.values = pairs_of(8, doubled), .rule = {}});
  EXPECT_EQ(compare(tasks[0].values, {}).verdict, Verdict::kWorse);
  for (const PairedComparison& c : compare_together(tasks)) {
    EXPECT_EQ(c.verdict, Verdict::kTooFewSeeds);
    EXPECT_EQ(c.seeds_needed, 11U);
    EXPECT_EQ(c.higher, 8U);
  }
  tasks.assign(45, {.values = pairs_of(11, doubled), .rule = {}});
  for (const PairedComparison& c : compare_together(tasks)) EXPECT_EQ(c.verdict, Verdict::kWorse);
}

TEST(CompareTogether, WhatIsEqualIsNoTest) {
  const auto doubled = [](auto i, double a) { return 2 * a + 0.01 * static_cast<double>(i); };
  std::vector<ComparisonTask> tasks(
      45, {.values = pairs_of(8, [](auto, double a) { return a; }), .rule = {}});
  tasks[7].values = pairs_of(8, doubled);
  tasks[8].values = pair_up({kNaN}, {1});
  const std::vector<PairedComparison> all = compare_together(tasks);
  EXPECT_EQ(all[7].verdict, Verdict::kWorse);
  EXPECT_DOUBLE_EQ(all[7].error, kFamilyError);
  EXPECT_FALSE(all[6].is_tested());
  EXPECT_FALSE(all[8].is_tested());
}

// The interval excludes 0 exactly where the p-value is small enough, at every level.
TEST(CompareTogether, IntervalsAndPValuesAgree) {
  boost::random::mt19937_64 random(11);
  boost::random::normal_distribution<double> normal;
  std::vector<ComparisonTask> tasks(40);
  for (std::size_t task = 0; task < tasks.size(); ++task) {
    const double shift = 0.05 * static_cast<double>(task);
    for (std::size_t i = 0; i < 20; ++i) {
      tasks[task].values.pairs.push_back({5 + normal(random), 5 + shift + normal(random)});
    }
  }
  int significant = 0;
  for (const PairedComparison& c : compare_together(tasks)) {
    const bool excludes = c.difference.low > 0 || c.difference.high < 0;
    EXPECT_EQ(excludes, c.adjusted_p <= kFamilyError);
    EXPECT_EQ(c.ratio.low > 1 || c.ratio.high < 1, excludes);
    EXPECT_EQ(c.verdict == Verdict::kBetter || c.verdict == Verdict::kWorse, excludes);
    significant += excludes ? 1 : 0;
  }
  EXPECT_GT(significant, 5);
  EXPECT_LT(significant, 38);
}

}  // namespace
}  // namespace simbench::evaluation
