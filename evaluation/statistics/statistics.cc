#include "evaluation/statistics/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/in_double.h"

namespace simbench::evaluation {
namespace {

constexpr double kLevel = 0.05;                     // of a test
constexpr double kTail = kLevel / 2;                // on each side of a 95 % interval
constexpr double kAsymptotic = 1.3581015157406195;  // sqrt(-ln(0.05 / 2) / 2)
constexpr std::size_t kMostExact = 1'000'000;       // n m

void leave_out_nan(std::vector<double>& values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
}

void sort_existing(std::vector<double>& values) {
  leave_out_nan(values);
  std::sort(values.begin(), values.end());
}

// The probability that the distance times n m is at least `bound`.
//
// An order of all values is a path from (0, 0) to (n, m): a step right for a value of the first
// sample, up for one of the second. All paths are equally likely. share[j] is the share of the
// paths to (i, j) that have stayed closer than `bound`; a path to there came from the left with
// probability i / (i + j).
double probability(std::int64_t n, std::int64_t m, std::int64_t bound) {
  if (bound <= 0) return 1;
  std::vector<double> share(static_cast<std::size_t>(m) + 1, 0.0);
  for (std::int64_t i = 0; i <= n; ++i) {
    for (std::int64_t j = 0; j <= m; ++j) {
      double& here = share[static_cast<std::size_t>(j)];
      if (i == 0 && j == 0) {
        here = 1;
      } else if (std::abs(i * m - j * n) >= bound) {
        here = 0;
      } else {
        const double below = j > 0 ? share[static_cast<std::size_t>(j - 1)] : 0;
        here = (here * static_cast<double>(i) + below * static_cast<double>(j)) /
               static_cast<double>(i + j);
      }
    }
  }
  return 1 - share.back();
}

}  // namespace

double quantile_of_sorted(const std::vector<double>& sorted, double p) {
  if (sorted.empty()) return kNan;
  const double position = static_cast<double>(sorted.size() - 1) * p;
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double share = position - static_cast<double>(below);
  return sorted[below] + share * (sorted[above] - sorted[below]);
}

double quantile(std::vector<double> values, double p) {
  SIMBENCH_ASSERT(p >= 0 && p <= 1, "the place of a quantile is a share");
  leave_out_nan(values);
  if (values.empty()) return kNan;
  // Only the two order statistics around the position must be in place.
  const auto below = static_cast<std::ptrdiff_t>(static_cast<double>(values.size() - 1) * p);
  std::nth_element(values.begin(), values.begin() + below, values.end());
  if (values.begin() + below + 1 != values.end()) {
    std::iter_swap(values.begin() + below + 1,
                   std::min_element(values.begin() + below + 1, values.end()));
  }
  return quantile_of_sorted(values, p);
}

double median_time(std::vector<double> values) {
  for (double& value : values) {
    if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
  }
  std::sort(values.begin(), values.end());
  if (values.empty()) return kNan;
  const double high = values[values.size() / 2];
  const double median = (values[(values.size() - 1) / 2] + high) / 2;
  return std::isfinite(median) ? median : kNan;
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

std::size_t count_of_existing(std::span<const double> values) {
  return static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [](double value) { return !std::isnan(value); }));
}

double mean_of(std::span<const double> values) {
  if (values.empty()) return kNan;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standard_deviation(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return values.size() < 2 ? kNan : std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double robust_deviation(std::vector<double> values) {
  const double middle = median(values);
  for (double& value : values) value = std::abs(value - middle);
  return kSigmasOfMedian * median(std::move(values));
}

double student_t_exceeded(double tail, double degrees_of_freedom) {
  const boost::math::students_t_distribution<double, InDouble> student(degrees_of_freedom);
  return boost::math::quantile(boost::math::complement(student, tail));
}

FittedLine fit_line(std::span<const double> x, std::span<const double> y) {
  FittedLine line{.slope = kNan, .mean_x = mean_of(x), .mean_y = mean_of(y)};
  double sum_xx = 0;
  double sum_xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum_xx += (x[i] - line.mean_x) * (x[i] - line.mean_x);
    sum_xy += (x[i] - line.mean_x) * (y[i] - line.mean_y);
  }
  if (sum_xx > 0) line.slope = sum_xy / sum_xx;
  return line;
}

Series make_series(std::vector<double> values) {
  std::vector<double> sorted = values;
  sort_existing(sorted);
  return {.values = std::move(values),
          .median = quantile_of_sorted(sorted, 0.5),
          .p05 = quantile_of_sorted(sorted, 0.05),
          .p95 = quantile_of_sorted(sorted, 0.95)};
}

Interval binomial_interval(std::int64_t successes, std::int64_t trials) {
  SIMBENCH_ASSERT(successes >= 0 && successes <= trials, "successes are some of the trials");
  using Binomial = boost::math::binomial_distribution<double, InDouble>;
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
  // With half a success, each bound is that of its own side: the wider interval.
  const double low = binomial_interval(halves / 2, count).low;
  const double high = binomial_interval((halves + 1) / 2, count).high;
  const double share = static_cast<double>(halves) / (2 * static_cast<double>(count));
  return {100 * share, 100 * low, 100 * high};
}

Percentile percent_at_most(double bound, const std::vector<double>& values) {
  const auto count = static_cast<std::int64_t>(count_of_existing(values));
  if (count == 0) return {kNan, kNan, kNan};
  const std::int64_t within =
      std::ranges::count_if(values, [bound](double value) { return value <= bound; });
  const auto [low, high] = binomial_interval(within, count);
  return {100 * static_cast<double>(within) / static_cast<double>(count), 100 * low, 100 * high};
}

Percentile percent_at_least(double bound, const std::vector<double>& values) {
  std::vector<double> mirrored = values;
  for (double& value : mirrored) value = -value;
  return percent_at_most(-bound, mirrored);
}

Placement placement_of(const Percentile& percentile) {
  constexpr double kLeast = 5;
  constexpr double kGreatest = 95;
  if (percentile.low >= kLeast && percentile.high <= kGreatest) return Placement::kInside;
  if (percentile.high < kLeast || percentile.low > kGreatest) return Placement::kOutside;
  return Placement::kTooFewSeeds;
}

MedianInterval median_interval(const std::vector<double>& values, std::int64_t seeds) {
  const double shape = (static_cast<double>(seeds) + 1) / 2;
  const double low_at = boost::math::ibeta_inv(shape, shape, kTail, InDouble());
  const double centre = median(values);
  MedianInterval interval;
  interval.seeds = seeds;
  interval.low = quantile(values, low_at);
  interval.high = quantile(values, 1 - low_at);  // the distribution is symmetric
  interval.relative = std::max(interval.high - centre, centre - interval.low) / std::fabs(centre);
  if (!std::isfinite(interval.relative)) interval.relative = kNan;
  return interval;
}

std::optional<std::int64_t> seeds_for(const std::vector<double>& values, double relative) {
  const auto enough = [&](std::int64_t seeds) {
    return median_interval(values, seeds).relative <= relative;
  };
  // The interval shrinks with more seeds: its quantiles move towards the median.
  if (!enough(kMostSeedsNeeded)) return std::nullopt;
  std::int64_t too_few = 0;
  std::int64_t many = kMostSeedsNeeded;
  while (many - too_few > 1) {
    const std::int64_t middle = too_few + (many - too_few) / 2;
    (enough(middle) ? many : too_few) = middle;
  }
  return many;
}

double ks_distance(std::vector<double> a, std::vector<double> b) {
  sort_existing(a);
  sort_existing(b);
  if (a.empty() || b.empty()) return kNan;
  double largest = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    const double value = std::min(a[i], b[j]);  // both step over all that are equal to it
    while (i < a.size() && a[i] == value) ++i;
    while (j < b.size() && b[j] == value) ++j;
    largest = std::max(largest, std::abs(static_cast<double>(i) / static_cast<double>(a.size()) -
                                         static_cast<double>(j) / static_cast<double>(b.size())));
  }
  return largest;
}

double ks_probability(std::size_t n, std::size_t m, double distance) {
  if (n == 0 || m == 0 || std::isnan(distance)) return kNan;
  // Distances are whole multiples of 1 / (n m), except for rounding.
  const double scaled = distance * static_cast<double>(n) * static_cast<double>(m);
  return probability(static_cast<std::int64_t>(n), static_cast<std::int64_t>(m),
                     static_cast<std::int64_t>(std::ceil(scaled - 1e-6)));
}

double ks_critical_distance(std::size_t n, std::size_t m) {
  if (n == 0 || m == 0) return kNan;
  const double product = static_cast<double>(n) * static_cast<double>(m);
  if (product > static_cast<double>(kMostExact)) {
    return kAsymptotic * std::sqrt(static_cast<double>(n + m) / product);
  }
  const auto rows = static_cast<std::int64_t>(n);
  const auto columns = static_cast<std::int64_t>(m);
  std::int64_t unlikely = rows * columns;  // the search for the smallest such bound is by halving
  if (probability(rows, columns, unlikely) > kLevel) return kNan;
  std::int64_t likely = 0;
  while (unlikely - likely > 1) {
    const std::int64_t middle = likely + (unlikely - likely) / 2;
    (probability(rows, columns, middle) > kLevel ? likely : unlikely) = middle;
  }
  // Only multiples of the common step occur as distances, not every multiple of 1 / (n m).
  const std::int64_t step = std::gcd(rows, columns);
  const std::int64_t steps = (unlikely + step - 1) / step;
  return static_cast<double>(steps * step) / product;
}

}  // namespace simbench::evaluation
