// Whether two samples can be of one distribution: the two-sample Kolmogorov-Smirnov test.
//
// The statistic is the largest distance between the two empirical distribution functions, from 0
// (the same values) to 1 (no overlap). Its critical value is exact for these sample sizes, by
// counting the orders in which the values of two samples of one continuous distribution can fall;
// with ties the test rejects less often than it says. Small samples are coarse: with 5 values on
// each side only distance 1 is significant, with 3 none is.
//
// Source: Hodges 1958, "The significance probability of the Smirnov two-sample test".
//
//   ks_distance({1, 2, 3}, {2, 3, 4});     // 1/3
//   ks_critical_distance(20, 20);          // 0.45: from there on they differ, at 5 %
#ifndef SIMBENCH_EVALUATION_STATISTICS_TWO_SAMPLE_KS_H_
#define SIMBENCH_EVALUATION_STATISTICS_TWO_SAMPLE_KS_H_

#include <cstddef>
#include <vector>

namespace simbench::evaluation {

// NaNs are left out; NaN if a sample has no value. O(n log n).
double ks_distance(std::vector<double> a, std::vector<double> b);

// The probability that samples of n and m values of one distribution are at least this far apart.
// O(n m).
double ks_probability(std::size_t n, std::size_t m, double distance);

// The smallest distance whose probability is at most 5 %; NaN if even 1 is likelier, or a sample is
// empty. Beyond n m = 1e6 the asymptotic 1.3581 sqrt((n + m) / (n m)). O(n m log(n m)).
double ks_critical_distance(std::size_t n, std::size_t m);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_STATISTICS_TWO_SAMPLE_KS_H_
