// Statistics over seeds: quantiles, a series with its band, the place of a published value in it,
// the number of seeds that a study needs, and the comparison of two samples.
//
// A quantity that a seed does not have is NaN: it stays in Series::values, which remain in seed
// order, and is left out of all computations. Without any value, the result is NaN.
//
//   const Series series = make_series({1, 2, 4});
//   seeds_for(series.values, 0.05);      // so many put the median within 5 % in 95 % of studies
//   ks_distance({1, 2, 3}, {2, 3, 4});   // 1/3
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace simbench::evaluation {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();  // does not exist

// Values in seed order, with the median and the 5-95 % band of those that exist.
struct Series {
  std::vector<double> values;
  double median = 0;
  double p05 = 0;
  double p95 = 0;
};

Series make_series(std::vector<double> values);

// Returns quantile p in [0, 1] by linear interpolation between order statistics: of n sorted values
// the one at index (n - 1) * p ("type 7" of Hyndman and Fan 1996, the default of R and NumPy).
// O(n).
double quantile(std::vector<double> values, double p);
// Needs values that all exist, in ascending order. O(1).
double quantile_of_sorted(const std::vector<double>& sorted, double p);

inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }
// The median of times until something is so, where NaN (never) is later than all others; NaN: half
// of them or more are.
double median_time(std::vector<double> values);

double mean_of_existing(const std::vector<double>& values);
std::size_t count_of_existing(std::span<const double> values);

// These two want values that all exist. The standard deviation is that of the population that the
// values are a sample of (divisor n - 1); NaN with fewer than two.
double mean_of(std::span<const double> values);
double standard_deviation(std::span<const double> values);

// A standard deviation in median absolute distances, of a normal distribution.
inline constexpr double kSigmasOfMedian = 1.4826;
// kSigmasOfMedian times the median absolute distance from the median: the standard deviation of
// normal noise, whatever a few outliers do. NaN without values.
double robust_deviation(std::vector<double> values);

// What Student's t of so many degrees of freedom (above 0) exceeds with the probability `tail`.
double student_t_exceeded(double tail, double degrees_of_freedom);

// The least-squares line of y over x, about the mean of x: numerically sound for any zero of x.
struct FittedLine {
  double slope = 0;  // NaN with fewer than two different x
  double mean_x = 0;
  double mean_y = 0;
  double at(double x) const { return mean_y + slope * (x - mean_x); }
};
FittedLine fit_line(std::span<const double> x, std::span<const double> y);

// A probability, as a share, between its bounds.
struct Interval {
  double low = 0;
  double high = 1;
};

// The 95 % confidence interval of a probability after `successes` in `trials`, exact (Clopper and
// Pearson 1934): it holds the probability in at least 95 % of all experiments.
Interval binomial_interval(std::int64_t successes, std::int64_t trials);

// A fraction of seeds with its 95 % binomial interval.
struct Percentile {
  double percent = 0;
  double low = 0;
  double high = 0;
};

// The percentage of the values that are below `published` (equal ones count half), with its
// interval as an estimate of the distribution's percentage.
Percentile percentile_of(double published, const std::vector<double>& values);

// The percentage of the values that are at or below `bound`, or at or above it, with its interval.
Percentile percent_at_most(double bound, const std::vector<double>& values);
Percentile percent_at_least(double bound, const std::vector<double>& values);

// Where a value lies in a distribution, as far as the seeds can tell: inside if the whole interval
// of its percentile lies from 5 to 95 %, outside if all of it lies beyond. One side of all seeds
// shows that with kFewestOutside seeds, the middle of them with four.
enum class Placement : std::uint8_t { kInside, kOutside, kTooFewSeeds };
inline constexpr std::int64_t kFewestOutside = 72;

Placement placement_of(const Percentile& percentile);

// The 95 % interval of the median of n seeds, from one large run that stands for the distribution.
//
// The median of n draws is near the order statistic of rank (n + 1) / 2, which is Beta-distributed
// for uniform draws. The interval therefore runs between two quantiles of the large run, without
// any assumption about the distribution. Source: David and Nagaraja, Order Statistics, 2003, 2.1.
struct MedianInterval {
  std::int64_t seeds = 0;
  double low = 0;
  double high = 0;
  double relative = 0;  // the farther end's distance from the large run's median, as a share of it
};

// Without values, or with a median of 0, `relative` is NaN.
MedianInterval median_interval(const std::vector<double>& values, std::int64_t seeds);

inline constexpr std::int64_t kMostSeedsNeeded = 1'000'000;

// The fewest seeds with which the interval is within `relative`; nothing beyond kMostSeedsNeeded.
std::optional<std::int64_t> seeds_for(const std::vector<double>& values, double relative);

// The two-sample Kolmogorov-Smirnov test: can two samples be of one distribution?
//
// The statistic is the largest distance between the two empirical distribution functions, from 0
// (the same values) to 1 (no overlap). Its critical value is exact for the sample sizes: it counts
// the orders in which the values of two samples of one continuous distribution can fall. With ties
// the test rejects less often than it states. Small samples are coarse: with 5 values on each side
// only distance 1 is significant, with 3 none is.
// Source: Hodges 1958, "The significance probability of the Smirnov two-sample test".

// NaN if a sample has no value. O(n log n).
double ks_distance(std::vector<double> a, std::vector<double> b);

// The probability that samples of n and m values of one distribution are at least this far apart.
// O(n m).
double ks_probability(std::size_t n, std::size_t m, double distance);

// The smallest distance whose probability is at most 5 %; NaN if even 1 is likelier, or a sample is
// empty. Beyond n m = 1e6 the asymptotic 1.3581 sqrt((n + m) / (n m)). O(n m log(n m)).
double ks_critical_distance(std::size_t n, std::size_t m);

}  // namespace simbench::evaluation
