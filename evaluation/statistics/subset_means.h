// The mean difference of paired values: its p-value and its interval, from the means of subsets.
//
// If the two values of a pair are interchangeable, as where nothing differs, their difference b - a
// has either sign with the same probability, whatever its size. Then the true mean 0 is equally
// likely to lie in any of the gaps between the ordered means of all 2^n - 1 nonempty subsets of n
// differences (J. A. Hartigan, "Using subsample values as typical values", J. Am. Stat. Assoc. 64,
// 1969). It follows, exactly and for tails of any weight,
//
//   p(0)      2 (1 + the smaller of the numbers of means from 0 on and up to 0) / 2^n, at most 1
//   interval  from the k-th smallest to the k-th largest mean, k = floor(2^n error / 2)
//
// and the interval excludes 0 if and only if p is at most the error: it is the test that flips
// signs (R. A. Fisher, The Design of Experiments, 1935, section 21), solved for the mean. With n
// pairs no p is below 2 / 2^n. Beyond `bits` pairs 2^bits - 1 subsets are drawn at random, always
// with the same random numbers; the test stays exact (Hartigan, theorem 3) and p is at least
// 2 / 2^bits.
//
// Where A and B differ, the interval holds the mean difference as often as it says if differences
// are symmetric about it, and less often if they are skewed and few: see
// tests/evaluation/statistics/subset_means_test.cc, also for the interval of the ratio of means,
// which comes from the same subsets and excludes 1 where that of the difference excludes 0.
//
// Cost: 2^bits n / 8 additions; 32 pairs with 16 bits in some 3 ms.
//
//   const SubsetMeans means({{1.5, 1.2}, {1.4, 1.3}}, 14);
//   if (means.p() <= 0.05) print(means.difference(0.05).low, means.difference(0.05).high);
#pragma once

#include <cstddef>
#include <vector>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

struct Pair {
  double a = 0;
  double b = 0;
};

// NaN: does not exist.
struct Estimate {
  double value = kNan;
  double low = kNan;
  double high = kNan;
};

class SubsetMeans {
 public:
  // `pairs`: one at least, of finite values; `bits` from 1 to 24.
  SubsetMeans(const std::vector<Pair>& pairs, unsigned bits);

  double p() const { return p_; }
  // The interval that holds with probability 1 - error; none below 2 / 2^n.
  Estimate difference(double error) const;  // mean of b - a
  // Mean of b / mean of a; NaN if the sum of a over all pairs, or over some subset, is not above 0.
  Estimate ratio(double error) const;

 private:
  void take_subset(std::size_t members, double sum_a, double sum_difference);
  Estimate between(const std::vector<double>& means, double value, double error) const;

  double difference_ = 0;
  double ratio_ = kNan;
  double rounding_ = 0;  // sums of differences up to this are 0
  bool all_equal_ = true;
  bool has_ratios_ = true;
  double p_ = 1;
  std::vector<double> differences_;  // of each subset
  std::vector<double> ratios_;
};

}  // namespace simbench::evaluation
