// Statistics over seeds: quantiles, a series with its band, where a published value lies in it.
//
// A quantity that a seed does not have is NaN: it stays in Series::values, so that these remain in
// seed order, and is left out of everything computed from them. Of no values at all, the result
// is NaN.
#ifndef SIMBENCH_EVALUATION_STATISTICS_STATISTICS_H_
#define SIMBENCH_EVALUATION_STATISTICS_STATISTICS_H_

#include <cstdint>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

// Quantile p in [0, 1] by linear interpolation between order statistics: of n sorted values, the
// one at index (n - 1) * p ("type 7" of Hyndman and Fan 1996, the default of R and NumPy).
// NaNs are left out. O(n).
double quantile(std::vector<double> values, double p);

inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

double mean_of_existing(const std::vector<double>& values);

// The values with their median and 5-95 % band.
Series make_series(std::vector<double> values);

// A probability, as a share, between its bounds.
struct Interval {
  double low = 0;
  double high = 1;
};

// The 95 % confidence interval of a probability after `successes` in `trials`, exact (Clopper and
// Pearson 1934): it holds the probability in at least 95 % of all experiments.
Interval binomial_interval(std::int64_t successes, std::int64_t trials);

// The percentage of the values that are below `published` (equal ones count half), with the
// interval of that percentage as an estimate of the distribution's.
Percentile percentile_of(double published, const std::vector<double>& values);

// Whether `published` lies between the 5 % and the 95 % quantile of the series.
bool inside(double published, const Series& series);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_STATISTICS_STATISTICS_H_
