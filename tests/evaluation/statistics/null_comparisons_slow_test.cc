// 200 comparisons in which nothing differs: how many show a verdict?
#include <gtest/gtest.h>

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <iostream>
#include <vector>

#include "evaluation/statistics/paired.h"

namespace simbench::evaluation {
namespace {

constexpr int kComparisons = 200;
// More than this of 200 comparisons, at 5 % each, are false in one of a thousand trials.
constexpr int kMostFalse = 20;

constexpr std::size_t kPipelines = 9;
constexpr std::size_t kMetrics = 5;

using Random = boost::random::mt19937_64;
using Values = std::array<std::array<double, kMetrics>, kPipelines>;

// One side of a seed: 45 values such as runs have. Heavy tails (e^N(0, 1), and one of 20 runs ten
// times worse), metrics of a pipeline that go together, a bad run that is bad for all pipelines,
// and a recall, which is 1 but for some runs.
Values draw_side(Random& random) {
  boost::random::normal_distribution<double> normal;
  const double run = std::exp(0.5 * normal(random)) * (random() % 20 == 0 ? 10 : 1);
  Values values;
  for (auto& pipeline : values) {
    const double common = run * std::exp(normal(random));
    for (double& value : pipeline) value = common * std::exp(0.3 * normal(random));
    pipeline.back() = random() % 10 == 0 ? 0.9 : 1;
  }
  return values;
}

// How many of the comparisons show better or worse anywhere.
int false_comparisons(std::size_t pairs, std::uint64_t seed) {
  Random random(seed);
  int some = 0;
  for (int comparison = 0; comparison < kComparisons; ++comparison) {
    std::vector<ComparisonTask> tasks(kPipelines * kMetrics);
    for (std::size_t i = 0; i < pairs; ++i) {
      const Values a = draw_side(random);
      const Values b = draw_side(random);
      for (std::size_t task = 0; task < tasks.size(); ++task) {
        tasks[task].values.pairs.push_back(
            {a[task / kMetrics][task % kMetrics], b[task / kMetrics][task % kMetrics]});
      }
    }
    bool found = false;
    for (const PairedComparison& each : compare_together(tasks)) {
      found = found || each.verdict == Verdict::kBetter || each.verdict == Verdict::kWorse;
    }
    some += found ? 1 : 0;
  }
  return some;
}

TEST(NullComparisons, AtMostOneOfTwentyShowsAnyVerdict) {
  const int few = false_comparisons(12, 1);
  const int many = false_comparisons(32, 2);
  std::cout << "of 200 comparisons with nothing different " << few << " (12 pairs) and " << many
            << " (32 pairs) show a verdict\n";
  EXPECT_LE(few, kMostFalse);
  EXPECT_LE(many, kMostFalse);
}

}  // namespace
}  // namespace simbench::evaluation
