// The metrics of simbench itself, for evaluation/scoring/metrics.h, which has the access to them.
#pragma once

#include <span>

#include "evaluation/scoring/metrics.h"

namespace simbench::evaluation {

std::span<const Metric> metric_table(ResultKind kind);

}  // namespace simbench::evaluation
