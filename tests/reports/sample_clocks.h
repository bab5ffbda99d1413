// Small made results of clock runs for the tests of reports/.
#pragma once

#include <string>
#include <vector>

#include "evaluation/clock_run/clock_evaluation.h"
#include "evaluation/clock_run/clock_score.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::reports {

// Every metric has the values 1, 2 and 6 times `scale`, but for the times.
inline evaluation::Row clock_row(const std::string& name, double scale) {
  evaluation::Row row;
  row.pipeline = row.host_sync = name;
  row.device_time = "raw_arrival";
  row.gathering = "yoon2021";
  for (const evaluation::Metric& metric : evaluation::metrics(evaluation::ResultKind::kClockRuns)) {
    metric.series(row) = evaluation::make_series({scale, 2 * scale, 6 * scale});
  }
  row.below_1_ms_s = evaluation::make_series({10, 20, evaluation::kNan});
  row.below_0_1_ms_s = evaluation::make_series({evaluation::kNan, 30, evaluation::kNan});
  row.below_0_01_ms_s = evaluation::make_series(std::vector<double>(3, evaluation::kNan));
  row.recovery_s = evaluation::make_series({evaluation::kNan, 5, 0});
  return row;
}

inline evaluation::StabilityCurves clock_curves_of(double scale) {
  evaluation::StabilityCurves curves;
  double value = scale;
  for (const evaluation::ClockCurve& curve : evaluation::clock_curves()) {
    curves.*curve.points = {{.tau_s = 1, .value = value, .terms = 100},
                            {.tau_s = 2, .value = value / 3, .terms = 50},
                            {.tau_s = 4, .value = value / 7, .terms = 20}};
    value *= 1.1;
  }
  return curves;
}

// "good", and the "oracle" whose clocks are the master's; three seeds of three hosts.
inline evaluation::ClockResults sample_clock_results() {
  evaluation::ClockResults all;
  evaluation::Results& results = all.results;
  results.kind = evaluation::ResultKind::kClockRuns;
  results.ranked_by = evaluation::RankedBy::kClockSpread;
  results.clock_period = {.from_s = 300, .duration_s = 36'000};
  results.scenario = "6host_star";
  results.first_seed = 4;
  results.seed_count = 3;
  results.rows = {clock_row("good", 0.5), clock_row("oracle", 0)};
  results.warnings = {"one was left out"};
  all.curves = {clock_curves_of(1e-9), clock_curves_of(0)};
  all.readings = {{.start_s = 300, .errors_s = {{0, 0}, {1.25e-6, 0.3000000000015}, {-2e-6, 0}}},
                  {.start_s = 300, .errors_s = {{0, 0}, {0, 0}, {0, 0}}}};
  return all;
}

}  // namespace simbench::reports
