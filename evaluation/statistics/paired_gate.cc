#include "evaluation/statistics/paired_gate.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace simbench::evaluation {
namespace {

using StudentsT = boost::math::students_t_distribution<double>;

double two_sided_p(double mean, double standard_error, std::size_t pairs) {
  if (mean == 0) return 1;
  if (standard_error == 0) return 0;
  const StudentsT t(static_cast<double>(pairs - 1));
  return 2 * boost::math::cdf(boost::math::complement(t, std::abs(mean / standard_error)));
}

}  // namespace

Estimate PairedT::interval(double error) const {
  if (pairs < 2) return {.value = mean};
  const StudentsT t(static_cast<double>(pairs - 1));
  const double half = standard_error * boost::math::quantile(boost::math::complement(t, error / 2));
  return {.value = mean, .low = mean - half, .high = mean + half};
}

PairedT paired_t(const PairedValues& values) {
  const std::size_t pairs = values.pairs.size();
  PairedT result{.pairs = pairs};
  if (pairs == 0) return result;
  const auto n = static_cast<double>(pairs);
  for (const Pair& pair : values.pairs) {
    result.mean_a += pair.a / n;
    result.mean += (pair.b - pair.a) / n;
  }
  if (pairs < 2) return result;
  double squares = 0;
  for (const Pair& pair : values.pairs) squares += std::pow(pair.b - pair.a - result.mean, 2);
  result.standard_error = std::sqrt(squares / (n - 1) / n);
  result.p = two_sided_p(result.mean, result.standard_error, pairs);
  return result;
}

std::vector<HolmDecision> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t left, std::size_t right) { return p[left] < p[right]; });
  std::vector<HolmDecision> decisions(p.size());
  double largest = 0;
  double error = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto left = static_cast<double>(order.size() - rank);
    // The first that is not rejected ends the procedure: all later ones keep its level, which
    // their larger p-values do not reach either.
    if (largest <= kFamilyError) error = kFamilyError / left;
    largest = std::max(largest, std::min(1.0, left * p[order[rank]]));
    decisions[order[rank]] = {.error = error, .adjusted_p = largest};
  }
  return decisions;
}

}  // namespace simbench::evaluation
