#include "evaluation/statistics/two_sample_ks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {
namespace {

constexpr double kLevel = 0.05;
constexpr double kAsymptotic = 1.3581015157406195;  // sqrt(-ln(0.05 / 2) / 2)
constexpr std::size_t kMostExact = 1'000'000;       // n m

void sort_existing(std::vector<double>& values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
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
  // Distances are whole multiples of 1 / (n m), but for what rounding made of them.
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
  std::int64_t unlikely = rows * columns;  // the smallest such bound is looked for by halving
  if (probability(rows, columns, unlikely) > kLevel) return kNan;
  std::int64_t likely = 0;
  while (unlikely - likely > 1) {
    const std::int64_t middle = likely + (unlikely - likely) / 2;
    (probability(rows, columns, middle) > kLevel ? likely : unlikely) = middle;
  }
  // Not every multiple of 1 / (n m) is a distance that occurs: those of their common step are.
  const std::int64_t step = std::gcd(rows, columns);
  const std::int64_t steps = (unlikely + step - 1) / step;
  return static_cast<double>(steps * step) / product;
}

}  // namespace simbench::evaluation
