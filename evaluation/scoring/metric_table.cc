// The metrics, in the order of the results' files. What their values mean: docs/design.md section
// 8, evaluation/scoring/alignment_scores.h, evaluation/clock_run/clock_score.h.
#include "evaluation/scoring/metric_table.h"

namespace simbench::evaluation {
namespace {

constexpr const char* kInFrames = "frames";
constexpr Judged kJudgedShare = {.smallest_step = 0.001,
                                 .margin = {.relative = 0.01, .absolute = 0.005}};
constexpr Judged kJudgedFrames = {.smallest_step = 0.01,  // a frame of a hundred cameras
                                  .margin = {.relative = 0.02, .absolute = 0.5}};
constexpr Judged kJudgedClocks = {.smallest_step = 1e-6,  // a nanosecond
                                  .margin = {.relative = 0.02, .absolute = 1e-6}};

constexpr Metric judged_by(Metric metric, const Judged& judged) {
  metric.judged = judged;
  return metric;
}

// Time errors are metrics of both kinds; only clock runs, which are long, are judged by them.
constexpr Metric time_error(const char* id, const char* title, SeriesPlace kept) {
  Metric metric;
  metric.id = id;
  metric.title = title;
  metric.unit = "ms";
  metric.needs = Needs::kTruth;
  metric.place = kept;
  metric.sweep = id;
  metric.is_new = true;
  return metric;
}
constexpr Metric kMaxTe =
    time_error("max_te_ms", "largest time error",
               {&MetricValues<double>::max_te_ms, &MetricValues<Series>::max_te_ms});
constexpr Metric kRmsTe =
    time_error("rms_te_ms", "RMS time error",
               {&MetricValues<double>::rms_te_ms, &MetricValues<Series>::rms_te_ms});
constexpr Metric kConstantTe =
    time_error("constant_te_ms", "constant time error",
               {&MetricValues<double>::constant_te_ms, &MetricValues<Series>::constant_te_ms});
constexpr Metric kDynamicTe =
    time_error("dynamic_te_ms", "dynamic time error",
               {&MetricValues<double>::dynamic_te_ms, &MetricValues<Series>::dynamic_te_ms});

constexpr Metric kPackets = {.id = "packets_per_s",
                             .title = "packets per second",
                             .unit = "1/s",
                             .better = Better::kNeither,
                             .place = SeriesPlace{&MetricValues<double>::packets_per_s,
                                                  &MetricValues<Series>::packets_per_s},
                             .sweep = "packets_per_s"};
constexpr Metric packets_of_captures() {
  Metric metric = kPackets;
  metric.csv = CsvForm::kValueAtEnd;
  metric.is_new = true;
  return metric;
}

// A metric that older archives may lack.
constexpr Metric new_metric(const char* id, const char* title, const char* unit, SeriesPlace kept) {
  Metric metric;
  metric.id = id;
  metric.title = title;
  metric.unit = unit;
  metric.place = kept;
  metric.is_new = true;
  return metric;
}

// Captures have values of these where their exposures are steered.
constexpr Metric alignment_metric(const char* id, const char* title, const char* unit,
                                  SeriesPlace kept) {
  Metric metric = new_metric(id, title, unit, kept);
  metric.needs = Needs::kTruth;
  metric.csv = CsvForm::kValueAtEnd;
  metric.sweep = id;
  return metric;
}

// Captures have values of these where cameras have depth and colour. No pipeline makes them better.
constexpr Metric colour_metric(const char* id, const char* title, SeriesPlace kept) {
  Metric metric = new_metric(id, title, "ms", kept);
  metric.better = Better::kNeither;
  metric.needs = Needs::kTruth;
  metric.csv = CsvForm::kValueAtEnd;
  metric.sweep = id;
  return metric;
}

// Captures have values of it where they are certified.
constexpr Metric certified_metric() {
  Metric metric =
      new_metric("certified_ms", "certified bound", "ms",
                 {&MetricValues<double>::certified_ms, &MetricValues<Series>::certified_ms});
  metric.csv = CsvForm::kValueAtEnd;
  metric.sweep = metric.id;
  return metric;
}

// To look at: in results.json, tidy CSV, sweep.csv and /published_figures, not in tables.
constexpr Metric unshown(const char* id, const char* title, const char* unit, SeriesPlace kept) {
  Metric metric = new_metric(id, title, unit, kept);
  metric.better = Better::kNeither;
  metric.sweep = id;
  return metric;
}

// Rows whose host synchronisation has sessions with delays have values of these.
constexpr Metric session_metric(const char* id, const char* title, const char* unit,
                                SeriesPlace kept) {
  Metric metric = new_metric(id, title, unit, kept);
  metric.better = Better::kNeither;
  metric.csv = CsvForm::kValueAtEnd;
  metric.sweep = id;
  return metric;
}

constexpr Metric kCaptureMetrics[] = {
    {.id = "amd_ms",
     .title = "AMD",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::amd_ms, &MetricValues<Series>::amd_ms},
     .csv = CsvForm::kBand,
     .sweep = "amd_ms",
     .judged = kJudgedMs},
    {.id = "rmdv_ms",
     .title = "RMDV",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::rmdv_ms, &MetricValues<Series>::rmdv_ms},
     .csv = CsvForm::kBand,
     .sweep = "rmdv_ms",
     .judged = kJudgedMs},
    {.id = "absolute_error_ms",
     .title = "absolute error",
     .unit = "ms",
     .needs = Needs::kTruth,
     .place = SeriesPlace{&MetricValues<double>::absolute_error_ms,
                          &MetricValues<Series>::absolute_error_ms},
     .csv = CsvForm::kBand,
     .sweep = "absolute_error_ms",
     .judged = kJudgedMs},
    {.id = "bias_ms",
     .title = "bias",
     .unit = "ms",
     .better = Better::kNearestZero,
     .needs = Needs::kTruth,
     .place = SeriesPlace{&MetricValues<double>::bias_ms, &MetricValues<Series>::bias_ms},
     .csv = CsvForm::kBand,
     .sweep = "bias_ms"},
    {.id = "host_error_ms",
     .title = "host clock error",
     .unit = "ms",
     .needs = Needs::kTruth,
     .place =
         SeriesPlace{&MetricValues<double>::host_error_ms, &MetricValues<Series>::host_error_ms},
     .csv = CsvForm::kBand,
     .sweep = "host_error_ms"},
    kMaxTe,
    kRmsTe,
    kConstantTe,
    kDynamicTe,
    packets_of_captures(),
    {.id = "exposure_spread_ms",
     .title = "exposure spread",
     .unit = "ms",
     .better = Better::kNeither,
     .needs = Needs::kTruth,
     .place = SeriesPlace{&MetricValues<double>::exposure_spread_ms,
                          &MetricValues<Series>::exposure_spread_ms},
     .csv = CsvForm::kBand,
     .sweep = "exposure_spread_ms"},
    {.id = "precision",
     .title = "precision",
     .unit = "share",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = &PooledValues::precision,
     .json_in = kInGathering,
     .csv = CsvForm::kValue,
     .sweep = "precision"},
    {.id = "recall",
     .title = "recall",
     .unit = "share",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = &PooledValues::recall,
     .json_in = kInGathering,
     .csv = CsvForm::kValue,
     .sweep = "recall"},
    {.id = "margin_ms",
     .title = "margin",
     .unit = "ms",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = &PooledValues::margin_ms,
     .json_in = kInGathering,
     .csv = CsvForm::kValue,
     .sweep = "margin_ms"},
    {.id = "seed_precision",
     .title = "precision",
     .unit = "share",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place =
         SeriesPlace{&MetricValues<double>::seed_precision, &MetricValues<Series>::seed_precision},
     .json_in = kInGathering},
    {.id = "seed_recall",
     .title = "recall",
     .unit = "share",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = SeriesPlace{&MetricValues<double>::seed_recall, &MetricValues<Series>::seed_recall},
     .json_in = kInGathering,
     .judged = kJudgedShare},
    {.id = "sets",
     .title = "complete sets",
     .better = Better::kHigher,
     .place = &SetCounts::emitted,
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd,
     .sweep = "sets"},
    {.id = "pure_sets",
     .title = "pure sets",
     .better = Better::kHigher,
     .needs = Needs::kVerifiedSets,
     .place = &SetCounts::pure,
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd,
     .sweep = "pure_sets"},
    {.id = "complete_pulses",
     .title = "complete pulses",
     .better = Better::kNeither,
     .needs = Needs::kVerifiedSets,
     .place = &SetCounts::complete_pulses,
     .json_in = kInGathering,
     .sweep = "complete_pulses"},
    {.id = "due_pulses",
     .title = "pulses due",
     .better = Better::kNeither,
     .needs = Needs::kVerifiedSets,
     .place = &SetCounts::due_pulses,
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd,
     .sweep = "due_pulses",
     .is_new = true},
    {.id = "exposed_pulses",
     .title = "pulses exposed by all cameras",
     .better = Better::kNeither,
     .needs = Needs::kVerifiedSets,
     .place = &SetCounts::exposed_pulses,
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd,
     .sweep = "exposed_pulses",
     .is_new = true},
    {.id = "partial_sets",
     .title = "partial sets",
     .place = &SetCounts::partial,
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd},
    {.id = "index_errors",
     .title = "index errors",
     .needs = Needs::kVerifiedSets,
     .place = &SetCounts::index_errors,
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd},
    {.id = "discarded_frames",
     .title = "discarded frames",
     .place = &SetCounts::discarded_frames,
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd},
    {.id = "set_amd_ms",
     .title = "AMD of sets",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::set_amd_ms, &MetricValues<Series>::set_amd_ms},
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd,
     .sweep = "set_amd_ms"},
    {.id = "set_absolute_error_ms",
     .title = "absolute error of sets",
     .unit = "ms",
     .needs = Needs::kTruth,
     .place = SeriesPlace{&MetricValues<double>::set_absolute_error_ms,
                          &MetricValues<Series>::set_absolute_error_ms},
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd,
     .sweep = "set_absolute_error_ms"},
    {.id = "emission_latency_ms",
     .title = "emission latency",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::emission_latency_ms,
                          &MetricValues<Series>::emission_latency_ms},
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd,
     .sweep = "emission_latency_ms"},
    {.id = "emission_latency_max_ms",
     .title = "largest emission latency",
     .unit = "ms",
     .place = &PooledValues::emission_latency_max_ms,
     .json_in = kInGathering,
     .csv = CsvForm::kValueAtEnd},
    {.id = "frames_expected",
     .title = "frames expected",
     .better = Better::kNeither,
     .place = &FrameCounts::expected,
     .json_in = kInFrames,
     .json_name = "expected",
     .csv = CsvForm::kValue},
    {.id = "frames_delivered",
     .title = "frames delivered",
     .better = Better::kHigher,
     .place = &FrameCounts::delivered,
     .json_in = kInFrames,
     .json_name = "delivered",
     .csv = CsvForm::kValue},
    {.id = "frames_dropped",
     .title = "frames dropped",
     .place = &FrameCounts::dropped,
     .json_in = kInFrames,
     .json_name = "dropped",
     .csv = CsvForm::kValue,
     .sweep = "frames_dropped"},
    {.id = "evaluated_pulses",
     .title = "pulses scored",
     .better = Better::kNeither,
     .place = &RunCounts::evaluated_pulses,
     .csv = CsvForm::kValue},
    {.id = "unsynchronised_hosts",
     .title = "unsynchronised hosts",
     .place = &RunCounts::unsynchronised_hosts,
     .csv = CsvForm::kValue,
     .sweep = "unsynchronised_hosts"},
    judged_by(alignment_metric("exposure_spread_median_ms", "median exposure spread", "ms",
                               {&MetricValues<double>::exposure_spread_median_ms,
                                &MetricValues<Series>::exposure_spread_median_ms}),
              kJudgedMs),
    judged_by(alignment_metric("exposure_spread_p95_ms", "95 % exposure spread", "ms",
                               {&MetricValues<double>::exposure_spread_p95_ms,
                                &MetricValues<Series>::exposure_spread_p95_ms}),
              kJudgedMs),
    alignment_metric(
        "aligned_1_ms_s", "time until aligned to 1 ms", "s",
        {&MetricValues<double>::aligned_1_ms_s, &MetricValues<Series>::aligned_1_ms_s}),
    alignment_metric(
        "aligned_0_1_ms_s", "time until aligned to 0.1 ms", "s",
        {&MetricValues<double>::aligned_0_1_ms_s, &MetricValues<Series>::aligned_0_1_ms_s}),
    alignment_metric(
        "aligned_0_01_ms_s", "time until aligned to 0.01 ms", "s",
        {&MetricValues<double>::aligned_0_01_ms_s, &MetricValues<Series>::aligned_0_01_ms_s}),
    judged_by(alignment_metric("disturbed_frames", "disturbed frames", "",
                               {&MetricValues<double>::disturbed_frames,
                                &MetricValues<Series>::disturbed_frames}),
              kJudgedFrames),
    alignment_metric(
        "exposure_drift_ppm", "exposure drift", "ppm",
        {&MetricValues<double>::exposure_drift_ppm, &MetricValues<Series>::exposure_drift_ppm}),
    alignment_metric("wrong_locks", "wrong locks", "",
                     {&MetricValues<double>::wrong_locks, &MetricValues<Series>::wrong_locks}),
    unshown(
        "rmdv_printed_sqrt_ms", "RMDV as printed", "sqrt(ms)",
        {&MetricValues<double>::rmdv_printed_sqrt_ms, &MetricValues<Series>::rmdv_printed_sqrt_ms}),
    unshown("rmdv_printed_share", "pulses with an RMDV as printed", "share",
            {&MetricValues<double>::rmdv_printed_share, &MetricValues<Series>::rmdv_printed_share}),
    colour_metric(
        "colour_offset_ms", "colour offset",
        {&MetricValues<double>::colour_offset_ms, &MetricValues<Series>::colour_offset_ms}),
    colour_metric("colour_offset_spread_ms", "spread of the colour offset",
                  {&MetricValues<double>::colour_offset_spread_ms,
                   &MetricValues<Series>::colour_offset_spread_ms}),
    session_metric("t_l_ms", "network synchronisation delay", "ms",
                   {&MetricValues<double>::t_l_ms, &MetricValues<Series>::t_l_ms}),
    session_metric("t_t_ms", "time synchronisation delay", "ms",
                   {&MetricValues<double>::t_t_ms, &MetricValues<Series>::t_t_ms}),
    session_metric("t_d_ms", "added delay", "ms",
                   {&MetricValues<double>::t_d_ms, &MetricValues<Series>::t_d_ms}),
    session_metric("session_passes", "passes of a session", "",
                   {&MetricValues<double>::session_passes, &MetricValues<Series>::session_passes}),
    session_metric("get_time_ms", "duration of a get of the clock", "ms",
                   {&MetricValues<double>::get_time_ms, &MetricValues<Series>::get_time_ms}),
    session_metric("set_time_ms", "duration of a set of the clock", "ms",
                   {&MetricValues<double>::set_time_ms, &MetricValues<Series>::set_time_ms}),
    session_metric(
        "message_time_ms", "duration of a message", "ms",
        {&MetricValues<double>::message_time_ms, &MetricValues<Series>::message_time_ms}),
    certified_metric(),
};

constexpr Metric kClockMetrics[] = {
    {.id = "clock_spread_ms",
     .title = "spread of the clocks",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::clock_spread_ms,
                          &MetricValues<Series>::clock_spread_ms},
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
     .sweep = "clock_spread_p95_ms"},
    {.id = "clock_spread_max_ms",
     .title = "largest spread of the clocks",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::clock_spread_max_ms,
                          &MetricValues<Series>::clock_spread_max_ms},
     .sweep = "clock_spread_max_ms"},
    judged_by(kMaxTe, kJudgedClocks),
    judged_by(kRmsTe, kJudgedClocks),
    kConstantTe,
    kDynamicTe,
    {.id = "below_1_ms_s",
     .title = "time until below 1 ms",
     .unit = "s",
     .place = SeriesPlace{&MetricValues<double>::below_1_ms_s, &MetricValues<Series>::below_1_ms_s},
     .sweep = "below_1_ms_s"},
    {.id = "below_0_1_ms_s",
     .title = "time until below 0.1 ms",
     .unit = "s",
     .place =
         SeriesPlace{&MetricValues<double>::below_0_1_ms_s, &MetricValues<Series>::below_0_1_ms_s},
     .sweep = "below_0_1_ms_s"},
    {.id = "below_0_01_ms_s",
     .title = "time until below 0.01 ms",
     .unit = "s",
     .place = SeriesPlace{&MetricValues<double>::below_0_01_ms_s,
                          &MetricValues<Series>::below_0_01_ms_s},
     .sweep = "below_0_01_ms_s"},
    {.id = "holdover_60_ms",
     .title = "error after 60 s without the master",
     .unit = "ms",
     .place =
         SeriesPlace{&MetricValues<double>::holdover_60_ms, &MetricValues<Series>::holdover_60_ms},
     .sweep = "holdover_60_ms"},
    {.id = "holdover_600_ms",
     .title = "error after 600 s without the master",
     .unit = "ms",
     .place = SeriesPlace{&MetricValues<double>::holdover_600_ms,
                          &MetricValues<Series>::holdover_600_ms},
     .sweep = "holdover_600_ms",
     .judged = kJudgedClocks},
    {.id = "recovery_s",
     .title = "recovery",
     .unit = "s",
     .place = SeriesPlace{&MetricValues<double>::recovery_s, &MetricValues<Series>::recovery_s},
     .sweep = "recovery_s"},
    kPackets,
};

}  // namespace

std::span<const Metric> metric_table(ResultKind kind) {
  if (kind == ResultKind::kCaptures) return kCaptureMetrics;
  return kClockMetrics;
}

}  // namespace simbench::evaluation
