// How many seeds a study needs: how wide the 95 % interval of a median is with n of them.
//
// From one large run, taken as the distribution of a metric. The median of n draws is near the
// order statistic of rank (n + 1) / 2, and of uniform draws that is Beta-distributed; so its
// interval runs between two quantiles of the large run. Nothing is assumed about the metric's
// distribution and nothing is drawn. Source: David and Nagaraja, Order Statistics, 2003, 2.1.
//
//   seeds_for(values, 0.05)   // 290: with so many the median is within 5 % in 95 % of all studies
#ifndef SIMBENCH_EVALUATION_STATISTICS_SEEDS_NEEDED_H_
#define SIMBENCH_EVALUATION_STATISTICS_SEEDS_NEEDED_H_

#include <cstdint>
#include <optional>
#include <vector>

namespace simbench::evaluation {

// Where the median of n seeds lies in 95 % of all studies.
struct MedianInterval {
  std::int64_t seeds = 0;
  double low = 0;
  double high = 0;
  double relative = 0;  // the farther end's distance from the large run's median, as a share of it
};

// NaNs among the values are left out; of no values, or a median of 0, `relative` is NaN.
MedianInterval median_interval(const std::vector<double>& values, std::int64_t seeds);

inline constexpr std::int64_t kMostSeedsNeeded = 1'000'000;

// The fewest seeds with which the interval is within `relative`; nothing beyond kMostSeedsNeeded.
std::optional<std::int64_t> seeds_for(const std::vector<double>& values, double relative);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_STATISTICS_SEEDS_NEEDED_H_
