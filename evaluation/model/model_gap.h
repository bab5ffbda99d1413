// Measured beside simulated: how far the model is from what it models.
//
// Both sides are results of the same scenario and pipelines: one measured, where true clock errors
// are known (an experiment whose clocks share one) or at least GenLock order, one simulated. Their
// repetitions are independent draws, not pairs, so distributions are compared: quantiles side by
// side, and the two-sample Kolmogorov-Smirnov distance with its critical value for these sample
// sizes. Distance below the critical value: no difference was found, which with few repetitions is
// weak evidence (two_sample_ks.h).
//
//   for (const ModelGapRow& row : model_gap(measured, simulated)) use(row.metric, row.ks);
#ifndef SIMBENCH_EVALUATION_MODEL_MODEL_GAP_H_
#define SIMBENCH_EVALUATION_MODEL_MODEL_GAP_H_

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

// The metrics that are compared, in this order (evaluation/scoring/metrics.h).
inline constexpr std::array<const char*, 4> kGapMetrics = {"host_error_ms", "amd_ms", "rmdv_ms",
                                                           "absolute_error_ms"};

// The quantiles that are compared, as shares.
inline constexpr std::array<double, 5> kGapQuantiles = {0.05, 0.25, 0.5, 0.75, 0.95};

// Below this measured median a relative gap says more about noise than about the model.
inline constexpr double kSmallestJudgedMs = 0.05;
inline constexpr double kLargestGap = 0.2;

struct GapSide {
  Series series;
  std::size_t count = 0;  // of values that exist
  std::array<double, kGapQuantiles.size()> quantiles{};
};

struct ModelGapRow {
  std::string pipeline;
  std::string metric;  // of kGapMetrics
  GapSide measured;
  GapSide simulated;
  double ks = 0;           // NaN: a side has no value
  double ks_critical = 0;  // at 5 %; NaN: so few values that no distance is significant
  double median_gap = 0;   // (simulated - measured) / measured
  // Whether the medians are within 20 %; nothing below kSmallestJudgedMs or without a value.
  std::optional<bool> within_20_percent;

  bool significant() const { return ks >= ks_critical; }  // false where either is NaN
};

// A row per pipeline and metric, in the order of `measured`; pipelines that only one side has, and
// metrics that have no value on either side, have none.
std::vector<ModelGapRow> model_gap(const Results& measured, const Results& simulated);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_MODEL_MODEL_GAP_H_
