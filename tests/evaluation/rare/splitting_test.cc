// Importance splitting where the probability is known.
#include "evaluation/rare/splitting.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "tests/evaluation/rare/rare_worlds.h"

namespace simbench::evaluation {
namespace {

// Bounds whose normal tail and whose tail of the largest of 24 exponentials are 1e-4 and 1e-6.
constexpr double kNormal4 = 3.71902;
constexpr double kNormal6 = 4.75342;
constexpr double kLargest4 = 12.3883;
constexpr double kLargest6 = 16.9936;

RareFunction normal_sums(double bound) {
  return world_of(bound, [](std::uint64_t seed) { return normal_sum(seed, 20); });
}
RareFunction largest(double bound) {
  return world_of(bound, [](std::uint64_t seed) { return largest_exponential(seed, 24); });
}

// How many runs brute force needs for the standard error of these repeats' mean.
double brute_force_runs(const RareEstimate& estimate, double probability) {
  const double error = standard_deviation(estimate.repeats) /
                       std::sqrt(static_cast<double>(estimate.repeats.size())) / probability;
  return 1 / (probability * error * error);
}

TEST(Splitting, TestsKnowTheirProbabilities) {
  EXPECT_NEAR(normal_tail(kNormal4), 1e-4, 1e-8);
  EXPECT_NEAR(normal_tail(kNormal6), 1e-6, 1e-10);
  EXPECT_NEAR(largest_tail(kLargest4, 24), 1e-4, 1e-7);
  EXPECT_NEAR(largest_tail(kLargest6, 24), 1e-6, 1e-9);
}

TEST(Splitting, IsNearBruteForceWhereThatIsAffordable) {
  const RareFunction run = normal_sums(kNormal4);
  const SplittingOptions options{.bound = kNormal4};
  const RareEstimate split = estimate_rare(run, options, nullptr);
  const RareEstimate counted = count_rare(run, 400000, options, nullptr);
  EXPECT_LE(counted.low, 1e-4);
  EXPECT_GE(counted.high, 1e-4);
  EXPECT_LT(std::abs(std::log(split.probability / counted.probability)), std::log(1.5));
  EXPECT_LE(split.low, counted.high);
  EXPECT_GE(split.high, counted.low);
  EXPECT_LT(split.runs, counted.runs / 4);
}

TEST(Splitting, FindsOneInAMillionAtAHundredthOfTheCost) {
  const RareEstimate split = estimate_rare(
      largest(kLargest6), {.bound = kLargest6, .starts = 256, .repeats = 16}, nullptr);
  EXPECT_LE(split.low, 1e-6);
  EXPECT_GE(split.high, 1e-6);
  EXPECT_LT(std::abs(std::log(split.probability / 1e-6)), std::log(1.5));
  EXPECT_GT(brute_force_runs(split, 1e-6) / static_cast<double>(split.runs), 100);
}

// Few runs, so that a bias would show; 40 experiments.
TEST(Splitting, IsUnbiasedAndItsIntervalHoldsTheTruth) {
  std::vector<double> estimates;
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const RareEstimate split = estimate_rare(
        largest(kLargest4),
        {.bound = kLargest4, .seed = seed, .starts = 128, .chains = 64, .moves = 4}, nullptr);
    ASSERT_FALSE(split.is_below) << "seed " << seed;
    estimates.push_back(split.probability);
    if (split.low <= 1e-4 && 1e-4 <= split.high) ++inside;
  }
  const double error = standard_deviation(estimates) / std::sqrt(40.0);
  EXPECT_NEAR(mean_of(estimates), 1e-4, 4 * error);
  EXPECT_LT(error, 0.15e-4);
  EXPECT_GE(inside, 36) << "of 40, 38 are expected";
}

TEST(Splitting, IsTheSameWithAnyNumberOfThreads) {
  const auto estimate = [](unsigned jobs) {
    return estimate_rare(normal_sums(3),
                         {.bound = 3, .starts = 64, .chains = 8, .repeats = 4, .jobs = jobs},
                         nullptr);
  };
  const RareEstimate one = estimate(1);
  const RareEstimate four = estimate(4);
  EXPECT_EQ(one.probability, four.probability);
  EXPECT_EQ(one.repeats, four.repeats);
  EXPECT_EQ(one.levels, four.levels);
  EXPECT_EQ(one.runs, four.runs);
  const RareEstimate other = estimate_rare(
      normal_sums(3), {.bound = 3, .seed = 2, .starts = 64, .chains = 8, .repeats = 4, .jobs = 1},
      nullptr);
  EXPECT_NE(one.probability, other.probability);
}

// Nothing to split: the part of all started runs.
TEST(Splitting, OfTheOrdinaryIsCounting) {
  const RareEstimate split = estimate_rare(normal_sums(0), {.bound = 0}, nullptr);
  EXPECT_TRUE(split.levels.empty());
  EXPECT_NEAR(split.probability, 0.5, 0.1);
  EXPECT_EQ(split.runs, 9 * 1024U);
}

TEST(Splitting, SaysWhatIsTooRare) {
  const RareFunction never =
      world_of(2, [](std::uint64_t seed) { return sim::RandomStream(seed, "level").uniform(); });
  const RareEstimate split = estimate_rare(never, {.bound = 2, .least_probability = 1e-5}, nullptr);
  EXPECT_TRUE(split.is_below);
  EXPECT_TRUE(std::isnan(split.probability));
  EXPECT_LT(split.high, 1e-3);
  const RareFunction same = world_of(2, [](std::uint64_t) { return 1.0; });
  EXPECT_TRUE(estimate_rare(same, {.bound = 2}, nullptr).is_below);
}

TEST(Splitting, OfWhatAlwaysHappensIsOne) {
  const RareFunction always = world_of(0, [](std::uint64_t) { return 1.0; });
  const RareEstimate split = estimate_rare(always, {.bound = 0}, nullptr);
  EXPECT_EQ(split.probability, 1);
  EXPECT_EQ(split.low, 1);
  EXPECT_EQ(split.high, 1);
}

TEST(Splitting, CountsPartsOfRuns) {
  // A quarter of the sets of the runs above the bound.
  const RareFunction part = [run = normal_sums(0)](const RareRun& each) {
    RareScore score = run(each);
    score.share /= 4;
    return score;
  };
  const RareEstimate counted = count_rare(part, 4000, {.bound = 0}, nullptr);
  EXPECT_NEAR(counted.probability, 0.125, 0.01);
  EXPECT_LT(counted.low, 0.125);
  EXPECT_GT(counted.high, 0.125);
  const RareEstimate none = count_rare(normal_sums(9), 100, {.bound = 9}, nullptr);
  EXPECT_EQ(none.probability, 0);
  EXPECT_EQ(none.high, binomial_interval(0, 100).high);
}

TEST(Splitting, EndsWhenItIsCancelled) {
  std::atomic<bool> cancel = false;
  const RareFunction run = [&cancel](const RareRun& each) {
    cancel = true;
    return RareScore{.level = static_cast<double>(each.seed % 100), .share = 0};
  };
  EXPECT_THROW(estimate_rare(run, {.bound = 200, .jobs = 1, .cancel = &cancel}, nullptr),
               EvaluationCancelled);
}

}  // namespace
}  // namespace simbench::evaluation
