// Two pipelines or archives measured in the same worlds: by how much does B differ from A, and is
// the difference significant?
//
// Values stand in pairs, one for each seed, so that differences between worlds cancel. A pair
// without one of its values (NaN) is left out and counted.
//
// Interval: 95 %, by bootstrap. Pairs are resampled kResamples times, always with the same random
// numbers, so that all metrics have the same resamples and equal input gives equal bytes. The
// percentiles are moved outward for small samples as in T. C. Hesterberg, "What teachers should
// know about the bootstrap", The American Statistician 69(4), 2015 (expanded percentile interval):
// with n = 8 and n = 32 pairs the interval holds the mean nearly as often as stated
// (tests/evaluation/statistics/paired_test.cc). Below kFewestPairs there is no interval: even the
// smallest and the largest of five differences enclose a mean only 94 times in 100.
//
// Verdict, with e = the smallest effect of interest, max(share of A's mean, an absolute floor):
//   interval excludes 0             better or worse
//   includes 0, lies within +-e     no difference seen
//   includes 0, reaches beyond e    too few seeds
// seeds_needed is the number of seeds with which the interval is narrower than e, so that it leads
// to one of the other verdicts. The width shrinks with the square root of the pairs.
//
// Cost: kResamples draws per pair; 1,000 pairs in about 5 ms.
//
//   const PairedComparison c = compare(pair_up(with.values, without.values), {});
//   if (c.verdict == Verdict::kBetter) print(c.ratio.value);
#ifndef SIMBENCH_EVALUATION_STATISTICS_PAIRED_H_
#define SIMBENCH_EVALUATION_STATISTICS_PAIRED_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

inline constexpr std::size_t kResamples = 2000;
inline constexpr std::size_t kFewestPairs = 6;  // the first n with 1 - 2^(1 - n) of 95 % or more

struct Pair {
  double a = 0;
  double b = 0;
};

struct PairedValues {
  std::vector<Pair> pairs;
  std::size_t left_out = 0;  // a value was NaN
};

// Pairs the i-th of `a` with the i-th of `b`, which are equally long.
PairedValues pair_up(const std::vector<double>& a, const std::vector<double>& b);

// NaN: does not exist.
struct Estimate {
  double value = kNan;
  double low = kNan;
  double high = kNan;
};

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
  double mean_a = kNan;
  double mean_b = kNan;
  double median_a = kNan;
  double median_b = kNan;
  Estimate difference;  // mean of b - a
  Estimate ratio;       // mean of b / mean of a; NaN if a resample's mean of a is not above 0
  double smallest_effect = 0;  // e, in the metric's unit
  Verdict verdict = Verdict::kTooFewSeeds;
  bool within_effect = false;      // the whole interval lies within +-e
  std::uint64_t seeds_needed = 0;  // only if too few; 0: unknown with fewer than two pairs
};

PairedComparison compare(const PairedValues& values, const ComparisonRule& rule);

// Student's t for paired differences, and Holm's correction for many of them: the test of a gate.
//
// A gate tests many metrics and must rarely raise a false alarm. Each metric's mean paired
// difference gets a two-sided p-value from Student's t with n - 1 degrees of freedom. Holm's
// step-down procedure (S. Holm, Scand. J. Statistics 6, 1979) keeps the probability that any of
// them excludes zero by chance within 5 %, whatever their dependence. interval() at
// HolmDecision::error excludes zero exactly where Holm rejects.
//
// If nothing changed, the two values of a pair are interchangeable. Their difference is then
// symmetric around zero however skewed the values are, and t on 32 or more symmetric differences
// rejects no more often than stated; tests/cli/commands/gate_null_slow_test.cc counts that on real
// runs.
//
//   const PairedT t = paired_t(pair_up(before, after));
inline constexpr double kFamilyError = 0.05;  // of all metrics of a gate together

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

#endif  // SIMBENCH_EVALUATION_STATISTICS_PAIRED_H_
