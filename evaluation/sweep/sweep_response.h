// How a sweep's metrics respond to what was swept: per point and pipeline, over all seeds.
#ifndef SIMBENCH_EVALUATION_SWEEP_SWEEP_RESPONSE_H_
#define SIMBENCH_EVALUATION_SWEEP_SWEEP_RESPONSE_H_

#include <cstddef>
#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"
#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"

namespace simbench::evaluation {

// One pipeline at one point.
struct ResponseRow {
  std::size_t point = 0;
  std::size_t pipeline = 0;
  std::vector<Series> series{};  // of every column of sweep.csv, over the seeds
  double precision = 0;          // over all seeds, as recall
  double recall = 0;
  std::vector<Series> hosts{};  // |mean clock error| of each host; the master's is first

  // By the name of the column, which must exist: of("amd_ms").median.
  const Series& of(std::string_view column) const;
};

// A row for each point and pipeline, in the order of the plan. `scores`: of all runs of the plan.
std::vector<ResponseRow> response(const SweepPlan& plan, const std::vector<SweepScore>& scores);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_SWEEP_RESPONSE_H_
