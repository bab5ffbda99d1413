// Two pipelines or archives measured in the same worlds: by how much does B differ from A, and is
// the difference significant?
//
// Values stand in pairs, one for each seed, so that differences between worlds cancel. A pair
// without one of its values (NaN) is left out and counted.
//
// Many comparisons are judged together. Each has the exact p-value of its mean difference, from the
// means of subsets of its pairs (subset_means.h). Holm's step-down procedure (S. Holm, Scand. J.
// Statistics 6, 1979) keeps the probability that any of the verdicts better and worse is false
// within kFamilyError, whatever the comparisons have in common. A comparison whose pairs are all
// equal shows no difference without a test and is not counted.
//
// Intervals are at the level that Holm leaves to the comparison (`error`), and exclude 0 exactly
// where it is significant. Below fewest_pairs(tests) pairs a single comparison can not be
// significant, however large its difference: the p-value of n pairs is at least 2 / 2^n. There is
// then no interval, but the effect, and in how many pairs B is higher.
//
// Verdict, with e = the smallest effect of interest, max(share of A's mean, an absolute floor):
//   interval excludes 0             better or worse
//   includes 0, lies within +-e     no difference seen
//   includes 0, reaches beyond e    too few seeds
// seeds_needed is the number of seeds with which, if mean and deviation of the differences stay as
// they are, the interval excludes 0 or is narrower than e, as if they were normal. It is a guess
// from few seeds, at least fewest_pairs().
//
//   const std::vector<PairedComparison> all = compare_together({{pair_up(before, after), {}}});
//   if (all[0].verdict == Verdict::kBetter) print(all[0].ratio.value);
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "evaluation/statistics/subset_means.h"

namespace simbench::evaluation {

// The probability of any false verdict among all tests that are made together.
inline constexpr double kFamilyError = 0.05;

struct PairedValues {
  std::vector<Pair> pairs;
  std::size_t left_out = 0;  // a value was NaN
};

// Pairs the i-th of `a` with the i-th of `b`, which are equally long.
PairedValues pair_up(const std::vector<double>& a, const std::vector<double>& b);

struct ComparisonRule {
  double smallest_effect = 0.05;  // as a share of A's mean
  double smallest_step = 0;       // and at least this, in the metric's unit
  bool higher_is_better = false;
};

enum class Verdict : std::uint8_t { kBetter, kWorse, kNoDifferenceSeen, kTooFewSeeds };

// Without any pair, values are NaN.
struct PairedComparison {
  std::size_t pairs = 0;
  std::size_t left_out = 0;
  std::size_t higher = 0;  // pairs in which B is higher
  std::size_t lower = 0;
  double mean_a = kNan;
  double mean_b = kNan;
  double median_a = kNan;
  double median_b = kNan;
  Estimate difference{};  // mean of b - a
  Estimate ratio{};       // mean of b / mean of a; NaN as SubsetMeans has it
  double p = 1;
  double adjusted_p = 1;        // by Holm: significant if at most kFamilyError
  double error = kFamilyError;  // the intervals hold with 1 - error
  double smallest_effect = 0;   // e, in the metric's unit
  Verdict verdict = Verdict::kTooFewSeeds;
  bool within_effect = false;      // the whole interval lies within +-e
  std::uint64_t seeds_needed = 0;  // only if too few; 0: unknown with fewer than two pairs

  bool is_tested() const { return higher + lower > 0; }
};

struct ComparisonTask {
  PairedValues values;
  ComparisonRule rule;
};

// In the order of `tasks`.
std::vector<PairedComparison> compare_together(const std::vector<ComparisonTask>& tasks);

// The fewest pairs with which one of so many tests can be significant: 6, 7, 7, 8 ...
std::size_t fewest_pairs(std::size_t tests);

// Student's t for paired differences, and Holm's correction for many of them: the test of a gate.
//
// A gate tests many metrics and must rarely raise a false alarm. Each metric's mean paired
// difference gets a two-sided p-value from Student's t with n - 1 degrees of freedom, and Holm's
// procedure corrects for their number, as above. interval() at
// HolmDecision::error excludes zero exactly where Holm rejects.
//
// If nothing changed, the two values of a pair are interchangeable. Their difference is then
// symmetric around zero however skewed the values are, and t on 32 or more symmetric differences
// rejects no more often than stated; tests/cli/commands/gate_null_slow_test.cc counts that on real
// runs.
//
//   const PairedT t = paired_t(pair_up(before, after));
struct PairedT {
  std::size_t pairs = 0;
  double mean_a = 0;
  double mean = 0;  // of b - a
  double standard_error = 0;
  double p = 1;  // two-sided; 1 where there are fewer than two pairs
  // The interval of the mean that holds it with probability 1 - `error`.
  Estimate interval(double error) const;
};

PairedT paired_t(const PairedValues& values);

struct HolmDecision {
  double error = kFamilyError;  // of this test: its interval holds with 1 - error
  double adjusted_p = 1;        // rejected if at most kFamilyError
};

// In the order of `p`.
std::vector<HolmDecision> holm(const std::vector<double>& p);

}  // namespace simbench::evaluation
