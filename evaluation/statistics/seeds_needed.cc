#include "evaluation/statistics/seeds_needed.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

MedianInterval median_interval(const std::vector<double>& values, std::int64_t seeds) {
  constexpr double kTail = 0.025;
  const double shape = (static_cast<double>(seeds) + 1) / 2;
  const double low_at = boost::math::ibeta_inv(shape, shape, kTail);
  const double centre = median(values);
  MedianInterval interval;
  interval.seeds = seeds;
  interval.low = quantile(values, low_at);
  interval.high = quantile(values, 1 - low_at);  // the distribution is symmetric
  interval.relative = std::max(interval.high - centre, centre - interval.low) / std::fabs(centre);
  if (!std::isfinite(interval.relative)) interval.relative = std::nan("");
  return interval;
}

std::optional<std::int64_t> seeds_for(const std::vector<double>& values, double relative) {
  const auto enough = [&](std::int64_t seeds) {
    return median_interval(values, seeds).relative <= relative;
  };
  // The interval shrinks as seeds grow: between quantiles that move towards the median.
  if (!enough(kMostSeedsNeeded)) return std::nullopt;
  std::int64_t too_few = 0;
  std::int64_t many = kMostSeedsNeeded;
  while (many - too_few > 1) {
    const std::int64_t middle = too_few + (many - too_few) / 2;
    (enough(middle) ? many : too_few) = middle;
  }
  return many;
}

}  // namespace simbench::evaluation
