#include "reports/figures/thin.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"

namespace simbench::reports {
namespace {

// A bucket gives two points, and each may be followed by a gap.
constexpr std::size_t kPointsOfABucket = 4;

// The indices to keep, in order, gaps aside: of each bucket the first of the smallest and the first
// of the largest.
std::vector<std::size_t> extremes(const std::vector<double>& y, std::size_t buckets) {
  std::vector<std::size_t> kept = {0};
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const std::size_t begin = y.size() * bucket / buckets;
    const std::size_t end = y.size() * (bucket + 1) / buckets;
    std::size_t least = end;
    std::size_t greatest = end;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isnan(y[i])) continue;
      if (least == end || y[i] < y[least]) least = i;
      if (greatest == end || y[i] > y[greatest]) greatest = i;
    }
    if (least == end) continue;
    const auto [first, second] = std::minmax(least, greatest);
    if (first != kept.back()) kept.push_back(first);
    if (second != kept.back()) kept.push_back(second);
  }
  if (kept.back() != y.size() - 1) kept.push_back(y.size() - 1);
  return kept;
}

}  // namespace

FigureSeries thinned(FigureSeries series, std::size_t most) {
  SIMBENCH_ASSERT(most >= 8, "room for the ends, a bucket and gaps");
  SIMBENCH_ASSERT(series.x.size() == series.y.size(), "a y for every x");
  if (series.x.size() <= most) return series;
  // The first and the last point may be beside those of the buckets, and have a gap each.
  const std::vector<std::size_t> kept =
      extremes(series.y, (most - kPointsOfABucket) / kPointsOfABucket);
  FigureSeries thin = {.label = std::move(series.label), .mark = series.mark, .x = {}, .y = {}};
  thin.colour = series.colour;
  std::size_t next = 0;  // of those not looked at
  for (const std::size_t index : kept) {
    for (; next < index && !std::isnan(series.y[next]); ++next) {
    }
    if (next < index) {
      thin.x.push_back(series.x[next]);
      thin.y.push_back(series.y[next]);
    }
    thin.x.push_back(series.x[index]);
    thin.y.push_back(series.y[index]);
    next = index + 1;
  }
  return thin;
}

}  // namespace simbench::reports
