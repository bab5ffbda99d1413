// How far the model can be trusted: the evidence for each stage, and measured beside simulated
// results. `simbench validate-model` prints both.
//
// Evidence: the experiment of six nodes behind a relay validates the implementation of transport
// and protocols; it has no cameras and no second oscillator. Each line names its sources, so that a
// reader can look up what was measured, by whom, and what nobody has measured.
//
// Gap: both sides are results of the same scenario and pipelines. The measured side knows true
// clock errors (an experiment whose clocks share one) or at least GenLock order. Repetitions are
// independent draws, not pairs, so distributions are compared: their quantiles, and the two-sample
// Kolmogorov-Smirnov distance with its critical value for these sample sizes. A distance below the
// critical value means that no difference was found; with few repetitions that is weak evidence.
//
//   for (const StageEvidence& stage : model_evidence()) print(stage.stage, stage.why);
//   for (const ModelGapRow& row : model_gap(measured, simulated)) use(row.metric, row.ks);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

enum class Evidence : std::uint8_t {
  kTheory,      // follows from arithmetic, or is tested against a closed form
  kExperiment,  // the real-network experiment of this project
  kRecording,   // recorded stamps of a real camera or network
  kPublished,   // figures or behaviour that others documented
  kAssumption,  // nobody measured it for this model
};

inline constexpr std::array<Evidence, 5> kAllEvidence = {Evidence::kTheory, Evidence::kExperiment,
                                                         Evidence::kRecording, Evidence::kPublished,
                                                         Evidence::kAssumption};

// "theory", "this experiment", "a real recording", "published figures", "assumption".
std::string_view name_of(Evidence evidence);

struct StageEvidence {
  std::string_view stage;
  std::array<bool, kAllEvidence.size()> rests_on;  // in the order of kAllEvidence
  std::string_view why;

  bool has(Evidence evidence) const { return rests_on[static_cast<std::size_t>(evidence)]; }
};

// In the order in which data passes through the model.
std::span<const StageEvidence> model_evidence();

// The metrics that are compared, in this order (evaluation/scoring/metrics.h).
inline constexpr std::array<const char*, 4> kGapMetrics = {"host_error_ms", "amd_ms", "rmdv_ms",
                                                           "absolute_error_ms"};

// The quantiles that are compared, as shares.
inline constexpr std::array<double, 5> kGapQuantiles = {0.05, 0.25, 0.5, 0.75, 0.95};

// Below this measured median a relative gap shows noise rather than the model.
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

// Returns a row per pipeline and metric, in the order of `measured`. Pipelines of one side alone
// and metrics without a value on either side have no row.
std::vector<ModelGapRow> model_gap(const Results& measured, const Results& simulated);

}  // namespace simbench::evaluation
