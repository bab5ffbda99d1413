#include "evaluation/sweep/ranking.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "evaluation/statistics/paired.h"

namespace simbench::evaluation {
namespace {

// Which of two pipelines is better at a point.
enum class BetterOf : std::uint8_t { kNeither, kFirst, kSecond };

double logarithm(double value) { return value > 0 ? std::log(value) : kNan; }

PairedT compare_logarithms(const Series& a, const Series& b) {
  std::vector<double> of_a;
  std::vector<double> of_b;
  std::ranges::transform(a.values, std::back_inserter(of_a), logarithm);
  std::ranges::transform(b.values, std::back_inserter(of_b), logarithm);
  return paired_t(pair_up(of_a, of_b));
}

// The comparisons of all pairs of pipelines at all points, corrected together.
class Comparisons {
 public:
  Comparisons(const SweepPlan& plan, const std::vector<ResponseRow>& rows, const Metric& metric)
      : pipelines_(plan.pipelines.size()) {
    std::vector<double> p;
    for (std::size_t point = 0; point < plan.points(); ++point) {
      for (std::size_t b = 1; b < pipelines_; ++b) {
        for (std::size_t a = 0; a < b; ++a) {
          const auto series = [&](std::size_t pipeline) -> const Series& {
            return rows[point * pipelines_ + pipeline].of(metric.sweep);
          };
          const PairedT t = compare_logarithms(series(a), series(b));
          signs_.push_back(t.mean > 0 ? BetterOf::kFirst : BetterOf::kSecond);
          p.push_back(t.mean == 0 || std::isnan(t.p) ? 1 : t.p);
        }
      }
    }
    const std::vector<HolmDecision> decisions = holm(p);
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (decisions[i].adjusted_p > kFamilyError) signs_[i] = BetterOf::kNeither;
    }
  }

  // a < b.
  BetterOf at(std::size_t point, std::size_t a, std::size_t b) const {
    return signs_[point * (pipelines_ * (pipelines_ - 1) / 2) + b * (b - 1) / 2 + a];
  }

 private:
  std::size_t pipelines_;
  std::vector<BetterOf> signs_;  // by point, then (0,1), (0,2), (1,2), (0,3) ...
};

RankedPoint ranked(const SweepPlan& plan, const std::vector<ResponseRow>& rows,
                   const Metric& metric, const Comparisons& comparisons, std::size_t point) {
  const std::size_t pipelines = plan.pipelines.size();
  const auto median = [&](std::size_t pipeline) {
    const double value = rows[point * pipelines + pipeline].value(metric);
    return std::isnan(value) ? HUGE_VAL : value;
  };
  RankedPoint result{.point = point, .order = std::vector<std::size_t>(pipelines), .is_apart = {}};
  std::iota(result.order.begin(), result.order.end(), std::size_t{0});
  std::ranges::stable_sort(result.order, {}, median);
  result.is_apart.reserve(pipelines);
  for (std::size_t i = 1; i < pipelines; ++i) {
    const auto [a, b] = std::minmax({result.order[i - 1], result.order[i]});
    result.is_apart.push_back(comparisons.at(point, a, b) != BetterOf::kNeither);
  }
  return result;
}

// The points along the first axis, for each combination of the other axes' steps.
std::vector<std::vector<std::size_t>> lines_of(const SweepPlan& plan) {
  std::map<std::vector<std::size_t>, std::vector<std::size_t>> lines;
  for (std::size_t point = 0; point < plan.points(); ++point) {
    std::vector<std::size_t> others = plan.steps(point);
    if (!others.empty()) others.front() = 0;
    lines[others].push_back(point);
  }
  std::vector<std::vector<std::size_t>> result;
  result.reserve(lines.size());
  for (auto& [others, points] : lines) result.push_back(std::move(points));
  return result;
}

void add_flips(const std::vector<std::size_t>& line, const Comparisons& comparisons, std::size_t a,
               std::size_t b, std::vector<RankingFlip>& flips) {
  BetterOf last = BetterOf::kNeither;
  std::size_t last_point = 0;
  for (const std::size_t point : line) {
    const BetterOf now = comparisons.at(point, a, b);
    if (now == BetterOf::kNeither) continue;
    if (last != BetterOf::kNeither && now != last) {
      const bool was_first = last == BetterOf::kFirst;
      flips.push_back({.before = was_first ? a : b,
                       .after = was_first ? b : a,
                       .last = last_point,
                       .first = point});
    }
    last = now;
    last_point = point;
  }
}

}  // namespace

Ranking rank(const SweepPlan& plan, const std::vector<ResponseRow>& rows, const Metric& metric) {
  const Comparisons comparisons(plan, rows, metric);
  Ranking ranking;
  ranking.points.reserve(plan.points());
  for (std::size_t point = 0; point < plan.points(); ++point) {
    ranking.points.push_back(ranked(plan, rows, metric, comparisons, point));
  }
  for (const std::vector<std::size_t>& line : lines_of(plan)) {
    for (std::size_t b = 1; b < plan.pipelines.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) add_flips(line, comparisons, a, b, ranking.flips);
    }
  }
  return ranking;
}

}  // namespace simbench::evaluation
