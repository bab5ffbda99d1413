// The metrics of simbench itself, for evaluation/scoring/metrics.h, which has the access to them.
#ifndef SIMBENCH_EVALUATION_SCORING_METRIC_TABLE_H_
#define SIMBENCH_EVALUATION_SCORING_METRIC_TABLE_H_

#include <span>

#include "evaluation/scoring/metrics.h"

namespace simbench::evaluation {

std::span<const Metric> metric_table(ResultKind kind);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_METRIC_TABLE_H_
