// The table of metrics of clock runs, ResultKind::kClockRuns; see evaluation/scoring/metrics.h,
// which has the access to it. What they mean: evaluation/clock_run/clock_score.h.
#ifndef SIMBENCH_EVALUATION_SCORING_CLOCK_METRICS_H_
#define SIMBENCH_EVALUATION_SCORING_CLOCK_METRICS_H_

#include "evaluation/scoring/metrics.h"

namespace simbench::evaluation {

inline constexpr Judged kJudgedClocks = {.smallest_step = 1e-6,  // a nanosecond
                                         .margin = {.relative = 0.02, .absolute = 1e-6}};

constexpr Metric in_clock_table(Metric metric, int place, bool is_judged) {
  metric.tables = {.clocks = place, .response = place};
  metric.legend_continues = *metric.legend != '\0';
  if (is_judged) metric.judged = kJudgedClocks;
  return metric;
}

constexpr Metric on_panel(Metric metric, int place) {
  metric.tables.response_panel = place;
  return metric;
}

constexpr Metric packets_of_clock_runs() {
  Metric metric = packets_metric();
  metric.tables = {.clocks = 13, .response = 8};
  return metric;
}

inline constexpr Metric kClockMetricTable[] = {
    {.id = "clock_spread_ms",
     .title = "spread of the clocks",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::clock_spread_ms,
                          &MetricValues<Series>::clock_spread_ms},
     .tables = {.clocks = 1, .response = 1, .response_panel = 1},
     .heading = "spread\nmean",
     .band_heading = "spread\n5-95 %",
     .legend = "spread: largest minus smallest clock of all hosts, its mean in time;",
     .sweep = "clock_spread_ms",
     .judged = kJudgedClocks},
    {.id = "clock_spread_median_ms",
     .title = "median spread of the clocks",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::clock_spread_median_ms,
                          &MetricValues<Series>::clock_spread_median_ms}},
    {.id = "clock_spread_p95_ms",
     .title = "95 % spread of the clocks",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::clock_spread_p95_ms,
                          &MetricValues<Series>::clock_spread_p95_ms},
     .tables = {.clocks = 2, .response = 2},
     .heading = "spread\np95",
     .sweep = "clock_spread_p95_ms"},
    {.id = "clock_spread_max_ms",
     .title = "largest spread of the clocks",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::clock_spread_max_ms,
                          &MetricValues<Series>::clock_spread_max_ms},
     .sweep = "clock_spread_max_ms"},
    on_panel(in_clock_table(kMaxTe, 3, true), 2),
    in_clock_table(kRmsTe, 4, true),
    in_clock_table(kConstantTe, 5, false),
    in_clock_table(kDynamicTe, 6, false),
    {.id = "below_1_ms_s",
     .title = "time until below 1 ms",
     .unit = "s",
     .place = SeriesPlace{&MetricValues<double>::below_1_ms_s, &MetricValues<Series>::below_1_ms_s},
     .tables = {.clocks = 7},
     .heading = "below\n1 ms",
     .legend = "below: when the spread is below for good.",
     .sweep = "below_1_ms_s"},
    {.id = "below_0_1_ms_s",
     .title = "time until below 0.1 ms",
     .unit = "s",
     .place =
         SeriesPlace{&MetricValues<double>::below_0_1_ms_s, &MetricValues<Series>::below_0_1_ms_s},
     .tables = {.clocks = 8},
     .heading = "below\n0.1 ms",
     .sweep = "below_0_1_ms_s"},
    {.id = "below_0_01_ms_s",
     .title = "time until below 0.01 ms",
     .unit = "s",
     .place = SeriesPlace{&MetricValues<double>::below_0_01_ms_s,
                          &MetricValues<Series>::below_0_01_ms_s},
     .tables = {.clocks = 9},
     .heading = "below\n0.01 ms",
     .sweep = "below_0_01_ms_s"},
    {.id = "holdover_60_ms",
     .title = "error after 60 s without the master",
     .unit = "ms",
     .place =
         SeriesPlace{&MetricValues<double>::holdover_60_ms, &MetricValues<Series>::holdover_60_ms},
     .tables = {.clocks = 10},
     .heading = "holdover\n60 s",
     .sweep = "holdover_60_ms"},
    {.id = "holdover_600_ms",
     .title = "error after 600 s without the master",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::holdover_600_ms,
                          &MetricValues<Series>::holdover_600_ms},
     .tables = {.clocks = 11, .response = 7, .response_panel = 3},
     .heading = "holdover\n600 s",
     .legend = "holdover: largest |TE| so long after the master was lost;",
     .sweep = "holdover_600_ms",
     .judged = kJudgedClocks},
    {.id = "recovery_s",
     .title = "recovery",
     .unit = "s",
     .place = SeriesPlace{&MetricValues<double>::recovery_s, &MetricValues<Series>::recovery_s},
     .tables = {.clocks = 12},
     .heading = "recovery",
     .legend = "recovery: from its return until the spread stays within the largest before.",
     .legend_continues = true,
     .sweep = "recovery_s"},
    packets_of_clock_runs(),
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_CLOCK_METRICS_H_
