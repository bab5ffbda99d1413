#include "evaluation/statistics/paired.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/in_double.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

constexpr double kMostSeeds = 1e15;  // the largest number needed that is reported

using StudentsT = boost::math::students_t_distribution<double, InDouble>;
using Normal = boost::math::normal_distribution<double, InDouble>;

// The number of subsets, as bits, with which the smallest p-value is an eighth of what Holm's first
// step asks for.
unsigned subset_bits(std::size_t tests) {
  constexpr double kTimesFiner = 8;
  constexpr unsigned kFewestBits = 12;
  constexpr unsigned kMostBits = 16;
  const double wanted =
      2 * kTimesFiner * static_cast<double>(std::max<std::size_t>(tests, 1)) / kFamilyError;
  return std::clamp(static_cast<unsigned>(std::ceil(std::log2(wanted))), kFewestBits, kMostBits);
}

// What needs no other comparison.
PairedComparison describe(const PairedValues& values, const ComparisonRule& rule) {
  const std::vector<Pair>& pairs = values.pairs;
  PairedComparison result{.pairs = pairs.size(), .left_out = values.left_out};
  if (pairs.empty()) return result;
  std::vector<double> a;
  std::vector<double> b;
  a.reserve(pairs.size());
  b.reserve(pairs.size());
  for (const Pair& pair : pairs) {
    a.push_back(pair.a);
    b.push_back(pair.b);
    result.higher += pair.b > pair.a ? 1 : 0;
    result.lower += pair.b < pair.a ? 1 : 0;
  }
  result.mean_a = mean_of(a);
  result.mean_b = mean_of(b);
  result.median_a = median(std::move(a));
  result.median_b = median(std::move(b));
  result.smallest_effect =
      std::max(rule.smallest_effect * std::abs(result.mean_a), rule.smallest_step);
  return result;
}

void show_equal(PairedComparison& result) {
  result.difference = {.value = 0, .low = 0, .high = 0};
  if (result.mean_a > 0) result.ratio = {.value = 1, .low = 1, .high = 1};
  result.verdict = Verdict::kNoDifferenceSeen;
  result.within_effect = true;
}

// The pairs with which the interval excludes 0 or is narrower than the smallest effect.
std::uint64_t seeds_needed(const std::vector<Pair>& pairs, const PairedComparison& comparison,
                           std::size_t fewest) {
  if (pairs.size() < 2) return 0;
  const double mean = comparison.difference.value;
  double squares = 0;
  for (const Pair& pair : pairs) squares += std::pow(pair.b - pair.a - mean, 2);
  const double deviation = std::sqrt(squares / static_cast<double>(pairs.size() - 1));
  const double z = -boost::math::quantile(Normal(), comparison.error / 2);
  const double half_width = std::max(std::abs(mean), comparison.smallest_effect / 2);
  const double by_scatter = half_width > 0 ? std::pow(z * deviation / half_width, 2) : kMostSeeds;
  const auto seeds = static_cast<std::uint64_t>(std::min(kMostSeeds, std::ceil(by_scatter)));
  return std::max({seeds, std::uint64_t{fewest}, std::uint64_t{pairs.size() + 1}});
}

void decide(const ComparisonTask& task, std::size_t fewest, PairedComparison& result) {
  const Estimate& difference = result.difference;
  const double effect = result.smallest_effect;
  result.within_effect = -effect <= difference.low && difference.high <= effect;
  if (result.adjusted_p <= kFamilyError) {
    const bool is_higher = difference.value > 0;
    result.verdict = is_higher == task.rule.higher_is_better ? Verdict::kBetter : Verdict::kWorse;
  } else if (result.within_effect) {
    result.verdict = Verdict::kNoDifferenceSeen;
  } else {
    result.seeds_needed = seeds_needed(task.values.pairs, result, fewest);
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

std::size_t fewest_pairs(std::size_t tests) {
  std::size_t pairs = 1;
  while (std::ldexp(2, -static_cast<int>(pairs)) * static_cast<double>(tests) > kFamilyError) {
    ++pairs;
  }
  return pairs;
}

std::vector<PairedComparison> compare_together(const std::vector<ComparisonTask>& tasks) {
  std::vector<PairedComparison> results;
  results.reserve(tasks.size());
  std::size_t tests = 0;
  for (const ComparisonTask& task : tasks) {
    results.push_back(describe(task.values, task.rule));
    tests += results.back().is_tested() ? 1 : 0;
  }
  const unsigned bits = subset_bits(tests);
  std::vector<double> p;
  p.reserve(tests);
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (results[i].is_tested()) p.push_back(SubsetMeans(tasks[i].values.pairs, bits).p());
  }
  const std::vector<HolmDecision> decisions = holm(p);
  std::size_t test = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    PairedComparison& result = results[i];
    if (!result.is_tested()) {
      if (result.pairs > 0) show_equal(result);
      continue;
    }
    result.p = p[test];
    result.adjusted_p = decisions[test].adjusted_p;
    result.error = decisions[test++].error;
    // Made again: the means of all tests together would need much memory.
    const SubsetMeans means(tasks[i].values.pairs, bits);
    result.difference = means.difference(result.error);
    result.ratio = means.ratio(result.error);
    decide(tasks[i], fewest_pairs(tests), result);
  }
  return results;
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
  const double half =
      standard_error * student_t_exceeded(error / 2, static_cast<double>(pairs - 1));
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
