#include "evaluation/statistics/paired.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <numeric>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/in_double.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kPairedTail = 0.025;              // on each side of a 95 % interval
constexpr std::uint64_t kRandomSeed = 20'151'104;  // arbitrary, but always the same
constexpr double kMostSeeds = 1e15;                // the largest number needed that is reported

struct Sums {
  double a = 0;
  double b = 0;
};

// Draws pairs from 32 random bits by multiplication, which favours some of n pairs by an
// insignificant 2^-32 n.
class PairDraw {
 public:
  explicit PairDraw(std::size_t pairs) : pairs_(pairs) {}
  Sums sums_of_resample(const std::vector<Pair>& pairs) {
    Sums sums;
    for (std::size_t i = 0; i < pairs_; ++i) {
      const Pair& pair = pairs[next()];
      sums.a += pair.a;
      sums.b += pair.b;
    }
    return sums;
  }

 private:
  std::size_t next() {
    return static_cast<std::size_t>((static_cast<std::uint64_t>(random_()) * pairs_) >> 32U);
  }

  std::uint64_t pairs_;
  boost::random::mt19937 random_{static_cast<std::uint32_t>(kRandomSeed)};
};

using StudentsT = boost::math::students_t_distribution<double, InDouble>;
using Normal = boost::math::normal_distribution<double, InDouble>;

// The share of resamples to leave on each side (Hesterberg 2015).
double expanded_tail(std::size_t pairs) {
  const auto n = static_cast<double>(pairs);
  const StudentsT t(n - 1);
  const double reach = std::sqrt(n / (n - 1)) * boost::math::quantile(t, kPairedTail);
  return boost::math::cdf(Normal(), reach);
}

// For equal differences every resample's mean is the same except for rounding, which must not show.
bool all_equal(const std::vector<Pair>& pairs) {
  const double first = pairs.front().b - pairs.front().a;
  return std::all_of(pairs.begin(), pairs.end(),
                     [&](const Pair& pair) { return pair.b - pair.a == first; });
}

void set_intervals(const std::vector<Pair>& pairs, PairedComparison& result) {
  const auto n = static_cast<double>(pairs.size());
  std::vector<double> differences;
  std::vector<double> ratios;
  PairDraw draw(pairs.size());
  for (std::size_t i = 0; i < kResamples; ++i) {
    const Sums sums = draw.sums_of_resample(pairs);
    differences.push_back((sums.b - sums.a) / n);
    if (sums.a > 0) ratios.push_back(sums.b / sums.a);
  }
  const double tail = expanded_tail(pairs.size());
  Estimate& difference = result.difference;
  difference.low = quantile(differences, tail);
  difference.high = quantile(std::move(differences), 1 - tail);
  if (all_equal(pairs)) difference.low = difference.high = difference.value;
  if (ratios.size() < kResamples) {
    result.ratio = {};
    return;
  }
  result.ratio.low = quantile(ratios, tail);
  result.ratio.high = quantile(std::move(ratios), 1 - tail);
}

// The width of an interval by the standard deviation, as if the differences were normal.
double width_by_deviation(const std::vector<Pair>& pairs, double mean) {
  double squares = 0;
  for (const Pair& pair : pairs) squares += std::pow(pair.b - pair.a - mean, 2);
  const auto n = static_cast<double>(pairs.size());
  const double z = -boost::math::quantile(Normal(), kPairedTail);
  return 2 * z * std::sqrt(squares / (n - 1) / n);
}

// The pairs with which an interval that is now `width` wide is narrower than the smallest effect.
std::uint64_t needed(std::size_t pairs, double width, double effect) {
  const double times = effect > 0 ? std::pow(width / effect, 2) : kMostSeeds;
  const double seeds = std::min(kMostSeeds, std::ceil(times * static_cast<double>(pairs)));
  return std::max({static_cast<std::uint64_t>(seeds), static_cast<std::uint64_t>(kFewestPairs),
                   static_cast<std::uint64_t>(pairs + 1)});
}

void decide(const std::vector<Pair>& pairs, const ComparisonRule& rule, PairedComparison& result) {
  const Estimate& difference = result.difference;
  if (pairs.size() < kFewestPairs) {
    if (pairs.size() >= 2) {
      const double width = width_by_deviation(pairs, difference.value);
      result.seeds_needed = needed(pairs.size(), width, result.smallest_effect);
    }
    return;
  }
  result.within_effect =
      -result.smallest_effect <= difference.low && difference.high <= result.smallest_effect;
  if (difference.low > 0 || difference.high < 0) {
    const bool is_higher = difference.low > 0;
    result.verdict = is_higher == rule.higher_is_better ? Verdict::kBetter : Verdict::kWorse;
  } else if (result.within_effect) {
    result.verdict = Verdict::kNoDifferenceSeen;
  } else {
    result.seeds_needed =
        needed(pairs.size(), difference.high - difference.low, result.smallest_effect);
  }
}

}  // namespace

PairedValues pair_up(const std::vector<double>& a, const std::vector<double>& b) {
  SIMBENCH_ASSERT(a.size() == b.size(), "values are paired one by one");
  PairedValues values;
  values.pairs.reserve(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) || std::isnan(b[i])) {
      ++values.left_out;
    } else {
      values.pairs.push_back({a[i], b[i]});
    }
  }
  return values;
}

PairedComparison compare(const PairedValues& values, const ComparisonRule& rule) {
  const std::vector<Pair>& pairs = values.pairs;
  PairedComparison result;
  result.pairs = pairs.size();
  result.left_out = values.left_out;
  if (pairs.empty()) return result;
  std::vector<double> a;
  std::vector<double> b;
  Sums sums;
  for (const Pair& pair : pairs) {
    a.push_back(pair.a);
    b.push_back(pair.b);
    sums.a += pair.a;
    sums.b += pair.b;
  }
  const auto n = static_cast<double>(pairs.size());
  result.mean_a = sums.a / n;
  result.mean_b = sums.b / n;
  result.median_a = median(std::move(a));
  result.median_b = median(std::move(b));
  result.difference.value =
      all_equal(pairs) ? pairs.front().b - pairs.front().a : (sums.b - sums.a) / n;
  if (sums.a > 0) result.ratio.value = sums.b / sums.a;
  result.smallest_effect =
      std::max(rule.smallest_effect * std::abs(result.mean_a), rule.smallest_step);
  if (pairs.size() >= kFewestPairs) set_intervals(pairs, result);
  decide(pairs, rule, result);
  return result;
}

namespace {

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
    // The first test that is not rejected ends the procedure: all later ones keep its level, which
    // their larger p-values do not reach either.
    if (largest <= kFamilyError) error = kFamilyError / left;
    largest = std::max(largest, std::min(1.0, left * p[order[rank]]));
    decisions[order[rank]] = {.error = error, .adjusted_p = largest};
  }
  return decisions;
}

}  // namespace simbench::evaluation
