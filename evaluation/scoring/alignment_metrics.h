// The table of metrics of captures whose exposures are steered; see evaluation/scoring/metrics.h,
// which has the access to it. What they mean: evaluation/scoring/alignment_scores.h. Other captures
// have no value of them.
#ifndef SIMBENCH_EVALUATION_SCORING_ALIGNMENT_METRICS_H_
#define SIMBENCH_EVALUATION_SCORING_ALIGNMENT_METRICS_H_

#include "evaluation/scoring/metrics.h"

namespace simbench::evaluation {

inline constexpr Judged kJudgedFrames = {.smallest_step = 0.01,  // a frame of a hundred cameras
                                         .margin = {.relative = 0.02, .absolute = 0.5}};

constexpr Metric alignment_metric(const char* id, const char* title, const char* unit,
                                  SeriesPlace kept, int place) {
  Metric metric;
  metric.id = id;
  metric.title = title;
  metric.unit = unit;
  metric.needs = Needs::kTruth;
  metric.place = kept;
  metric.tables.alignment = place;
  metric.csv = CsvColumns::kValueAtEnd;
  metric.sweep = id;
  metric.is_new = true;
  return metric;
}

constexpr Metric explained(Metric metric, const char* heading, const char* legend,
                           bool continues = false) {
  metric.heading = heading;
  metric.legend = legend;
  metric.legend_continues = continues;
  return metric;
}

constexpr Metric judged_by(Metric metric, const Judged& judged) {
  metric.judged = judged;
  return metric;
}

inline constexpr Metric kAlignmentMetricTable[] = {
    judged_by(
        explained(alignment_metric("exposure_spread_median_ms", "median exposure spread", "ms",
                                   {&MetricValues<double>::exposure_spread_median_ms,
                                    &MetricValues<Series>::exposure_spread_median_ms},
                                   1),
                  "exposure spread\nmedian",
                  "exposure spread: range of the true mid-exposures of all cameras that "
                  "belong together, its median and 95 % quantile over the evaluated pulses."),
        kJudgedMs),
    judged_by(explained(alignment_metric("exposure_spread_p95_ms", "95 % exposure spread", "ms",
                                         {&MetricValues<double>::exposure_spread_p95_ms,
                                          &MetricValues<Series>::exposure_spread_p95_ms},
                                         2),
                        "exposure spread\np95", ""),
              kJudgedMs),
    explained(
        alignment_metric(
            "aligned_1_ms_s", "time until aligned to 1 ms", "s",
            {&MetricValues<double>::aligned_1_ms_s, &MetricValues<Series>::aligned_1_ms_s}, 3),
        "aligned\nto 1 ms",
        "aligned: when, since the capture's start, the median spread of a second is below for "
        "good;"),
    explained(
        alignment_metric(
            "aligned_0_1_ms_s", "time until aligned to 0.1 ms", "s",
            {&MetricValues<double>::aligned_0_1_ms_s, &MetricValues<Series>::aligned_0_1_ms_s}, 4),
        "aligned\nto 0.1 ms", ""),
    explained(alignment_metric("aligned_0_01_ms_s", "time until aligned to 0.01 ms", "s",
                               {&MetricValues<double>::aligned_0_01_ms_s,
                                &MetricValues<Series>::aligned_0_01_ms_s},
                               5),
              "aligned\nto 0.01 ms", ""),
    judged_by(
        explained(
            alignment_metric(
                "disturbed_frames", "disturbed frames", "",
                {&MetricValues<double>::disturbed_frames, &MetricValues<Series>::disturbed_frames},
                6),
            "frames\ndisturbed",
            "disturbed: frames a camera of the whole capture, but for the cameras' unsteady start, "
            "whose length or exposure differs by more than 1 % from the camera's median (1 % of a "
            "frame is what nobody sees).",
            true),
        kJudgedFrames),
    explained(alignment_metric("exposure_drift_ppm", "exposure drift", "ppm",
                               {&MetricValues<double>::exposure_drift_ppm,
                                &MetricValues<Series>::exposure_drift_ppm},
                               7),
              "drift",
              "drift: how fast the exposures of the worst camera part from the reference camera's "
              "between corrections;"),
    explained(alignment_metric(
                  "wrong_locks", "wrong locks", "",
                  {&MetricValues<double>::wrong_locks, &MetricValues<Series>::wrong_locks}, 8),
              "wrong\nlocks",
              "wrong locks: cameras reported as aligned that expose more than a tenth of a period "
              "beside the reference camera.",
              true),
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SCORING_ALIGNMENT_METRICS_H_
