// What a sweep is ranked by, and at which of its points a pipeline failed (answer/standing.h): the
// same rules as for a run, so that a point of a sweep has the answer that a run of it has.
//
//   const RankedBy by = ranking_of(plan, rows);
//   const Ranking ranking = rank(plan, without_failed(rows, by), ranked_metric(by));
#pragma once

#include <vector>

#include "evaluation/answer/standing.h"
#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"

namespace simbench::evaluation {

// `rows`: response(plan, ...).
RankedBy ranking_of(const SweepPlan& plan, const std::vector<ResponseRow>& rows);

// Returns the rows without the value that ranks (NaN) where the pipeline failed.
std::vector<ResponseRow> without_failed(std::vector<ResponseRow> rows, RankedBy ranked_by);

}  // namespace simbench::evaluation
