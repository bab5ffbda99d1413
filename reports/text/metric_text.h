// A metric's values as reports show them, with their unit: a duration in the unit that fits, a
// share in percent, a count with its thousands set apart. No heading of a metric has a unit,
// therefore.
//
//   metric_text(evaluation::metric("amd_ms"), 0.0031);             // "3.10 us"
//   interval_text(evaluation::metric("amd_ms"), 0.35, 1.2);        // "[0.350, 1.20] ms"
//   difference_text(evaluation::metric("recall"), -0.02);          // "-2.00 %"
#pragma once

#include <string>

#include "evaluation/scoring/metrics.h"

namespace simbench::reports {

// "-" for what is not finite, here and below.
std::string metric_text(const evaluation::Metric& metric, double value);

// The difference of two values, and its interval. Shares differ by points of a percent.
std::string difference_text(const evaluation::Metric& metric, double difference);
std::string interval_text(const evaluation::Metric& metric, double low, double high);

// A value on an axis, whose unit is fixed: milliseconds unchanged, shares in percent.
double shown_value(const evaluation::Metric& metric, double value);

}  // namespace simbench::reports
