// At which value of the first axis does the order of the pipelines flip?
//
// At each point of a sweep the pipelines are ordered by the median of one metric over the seeds,
// the lowest first. Two pipelines are apart at a point if their paired differences, seed by seed
// and as logarithms (values of errors differ by factors), are not zero by chance: Student's t,
// corrected together over all pairs and points (Holm; evaluation/statistics/paired.h). Along the
// first axis, with all other axes fixed, the order of a pair flips where one is better, apart, and
// further on the other one is: the value lies between these two points.
//
// A seed for which one of the two has no value, or none above 0, does not count. Cost: a t-test for
// each pair of pipelines and point.
//
//   const Ranking ranking = rank(plan, rows, evaluation::metric("absolute_error_ms"));
//   for (const RankingFlip& flip : ranking.flips) print(flip.before, flip.last, flip.first);
#pragma once

#include <cstddef>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"

namespace simbench::evaluation {

// The order at one point.
struct RankedPoint {
  std::size_t point = 0;
  std::vector<std::size_t> order;  // pipelines, best first; those without a value are last
  std::vector<bool> is_apart;      // whether order[i] and order[i + 1] are
};

struct RankingFlip {
  std::size_t before = 0;  // the pipeline that is better at first
  std::size_t after = 0;   // and the one that is better then
  std::size_t last = 0;    // the last point at which `before` is better, apart
  std::size_t first = 0;   // the first point after it at which `after` is
};

struct Ranking {
  std::vector<RankedPoint> points;
  std::vector<RankingFlip> flips;  // by pair of pipelines
};

// `rows`: response(plan, ...). `metric` is a column of sweep.csv; lower is better.
Ranking rank(const SweepPlan& plan, const std::vector<ResponseRow>& rows, const Metric& metric);

}  // namespace simbench::evaluation
