// Measured results of a real rig beside the simulator's prediction for the same scenario.
//
// The measured median of each pipeline and metric stands beside the simulated band and is placed by
// its percentile (placement_of()). Inside means only that this number does not distinguish the rig
// from the simulated worlds. One repetition has a value and no band. An unverified row
// (evaluation/scoring/unverified_scores.h) is compared by the range of its gathered sets, which
// simulated rows have too; the others by AMD, RMDV and, where they exist, the errors.
//
//   Document document = results_document(measured, summary);
//   document.blocks.push_back(prediction_block(measured, simulated));
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/text/block.h"

namespace simbench::reports {

struct Prediction {
  std::string pipeline;
  std::string metric;  // "amd_ms", "rmdv_ms", "host_error_ms", "absolute_error_ms", "set_amd_ms"
  bool verified = true;
  evaluation::Series measured;
  evaluation::Series simulated;
  std::size_t measured_count = 0;  // of values that exist
  // Where the measured median lies among the simulated seeds; nothing if one does not exist.
  std::optional<evaluation::Percentile> percentile;
};

// Returns predictions in the order of `measured`. A pipeline that `simulated` lacks has none; one
// without measurements has a prediction alone.
std::vector<Prediction> predictions(const evaluation::Results& measured,
                                    const evaluation::Results& simulated);

Block prediction_block(const evaluation::Results& measured, const evaluation::Results& simulated);

// results.json of `measured` (reports/results/json.h) with one more member:
//   "prediction": {"seeds": {"first", "count"},
//                  "rows": [{"pipeline", "metric", "verified",
//                            "measured": {"count", "median", "p05", "p95"},
//                            "simulated": {"median", "p05", "p95"}, "inside": true, false or
//                            null (too few seeds, or a value does not exist)}]}
std::string json_with_prediction(const evaluation::Results& measured,
                                 const evaluation::Results& simulated);

}  // namespace simbench::reports
