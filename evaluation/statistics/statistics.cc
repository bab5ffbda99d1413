#include "evaluation/statistics/statistics.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>

#include "algorithms/ports/assert.h"

namespace simbench::evaluation {
namespace {

constexpr double kTail = 0.025;  // on each side of a 95 % interval

void leave_out_nan(std::vector<double>& values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
}

double quantile_of_sorted(const std::vector<double>& sorted, double p) {
  if (sorted.empty()) return kNan;
  const double position = static_cast<double>(sorted.size() - 1) * p;
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double share = position - static_cast<double>(below);
  return sorted[below] + share * (sorted[above] - sorted[below]);
}

}  // namespace

double quantile(std::vector<double> values, double p) {
  SIMBENCH_ASSERT(p >= 0 && p <= 1, "a quantile is asked for by a share");
  leave_out_nan(values);
  if (values.empty()) return kNan;
  // Only the two order statistics around the position have to be in place.
  const auto below = static_cast<std::ptrdiff_t>(static_cast<double>(values.size() - 1) * p);
  std::nth_element(values.begin(), values.begin() + below, values.end());
  if (values.begin() + below + 1 != values.end()) {
    std::iter_swap(values.begin() + below + 1,
                   std::min_element(values.begin() + below + 1, values.end()));
  }
  return quantile_of_sorted(values, p);
}

double mean_of_existing(const std::vector<double>& values) {
  double sum = 0;
  double count = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    count += 1;
  }
  return sum / count;  // 0/0 is NaN
}

Series make_series(std::vector<double> values) {
  std::vector<double> sorted = values;
  leave_out_nan(sorted);
  std::sort(sorted.begin(), sorted.end());
  return {.values = std::move(values),
          .median = quantile_of_sorted(sorted, 0.5),
          .p05 = quantile_of_sorted(sorted, 0.05),
          .p95 = quantile_of_sorted(sorted, 0.95)};
}

Interval binomial_interval(std::int64_t successes, std::int64_t trials) {
  SIMBENCH_ASSERT(successes >= 0 && successes <= trials, "successes are some of the trials");
  using Binomial = boost::math::binomial_distribution<double>;
  if (trials == 0) return {};
  const auto n = static_cast<double>(trials);
  const auto k = static_cast<double>(successes);
  return {Binomial::find_lower_bound_on_p(n, k, kTail),
          Binomial::find_upper_bound_on_p(n, k, kTail)};
}

Percentile percentile_of(double published, const std::vector<double>& values) {
  std::int64_t count = 0;
  std::int64_t halves = 0;  // twice the number below, plus the number equal
  for (const double value : values) {
    if (std::isnan(value)) continue;
    ++count;
    if (value < published) halves += 2;
    if (value == published) halves += 1;
  }
  if (count == 0) return {kNan, kNan, kNan};
  // With half a success, each bound is taken from its own side: the wider of the two intervals.
  const double low = binomial_interval(halves / 2, count).low;
  const double high = binomial_interval((halves + 1) / 2, count).high;
  const double share = static_cast<double>(halves) / (2 * static_cast<double>(count));
  return {100 * share, 100 * low, 100 * high};
}

bool inside(double published, const Series& series) {
  return series.p05 <= published && published <= series.p95;
}

}  // namespace simbench::evaluation
