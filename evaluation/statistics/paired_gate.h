// Student's t for paired differences, and Holm's correction for many of them: what a gate decides
// by.
//
// A gate asks one thing of many metrics and must rarely cry wolf. So each metric's mean paired
// difference gets a two-sided p-value from Student's t with n - 1 degrees of freedom, and Holm's
// step-down procedure (S. Holm, Scand. J. Statistics 6, 1979) keeps the chance that any of them
// excludes zero by accident within 5 %, whatever their dependence. interval() at holm_levels()
// excludes zero exactly where Holm rejects.
//
// Where nothing changed, the two values of a pair are interchangeable, so the difference is
// symmetric around zero however skewed the values are, and t on 32 or more symmetric differences
// rejects no more often than it says; tests/cli/commands/gate_null_slow_test.cc counts that on real
// runs.
//
//   const PairedT t = paired_t(pair_up(before, after));
#ifndef SIMBENCH_EVALUATION_STATISTICS_PAIRED_GATE_H_
#define SIMBENCH_EVALUATION_STATISTICS_PAIRED_GATE_H_

#include <cstddef>
#include <vector>

#include "evaluation/statistics/paired.h"

namespace simbench::evaluation {

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
  double error = kFamilyError;  // what this test may use: its interval is that of 1 - error
  double adjusted_p = 1;        // rejected if at most kFamilyError
};

// In the order of `p`.
std::vector<HolmDecision> holm(const std::vector<double>& p);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_STATISTICS_PAIRED_GATE_H_
