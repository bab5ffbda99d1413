// The output of `simbench validate-model`: measured beside simulated distributions, the distance
// between them, and the evidence for each stage of the model.
//
// JSON: {"schema_version": 1, "version", "commit", "scenario",
//        "based_on", "changed", "published_left_out": see state_derivation(); of what was
//        simulated, "measured_on": {"date", "machine", "commit", "changed"}, "simulated_seeds":
//        ..., "rows": [{"pipeline", "metric",
//                  "measured": {"count", "median", "p05", "p25", "p75", "p95", "values"},
//                  "simulated": likewise, "ks", "ks_critical", "significant", "median_gap",
//                  "within_20_percent": true, false or null}],
//        "notes": [...], "evidence": [{"stage", "rests_on": ["theory", ...], "why"}]}
//
//   const MeasuredStudy study = read_measured_study(path, scenario.name);
//   std::cout << plain(model_gap_document(model_gap_report(study, simulated)));
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/model/evidence.h"
#include "evaluation/scoring/results.h"
#include "reports/recordings/measured_study.h"
#include "reports/text/block.h"

namespace simbench::reports {

struct ModelGapReport {
  MeasuredStudy measured;
  scenarios::Derivation derivation{};  // of the simulated scenario
  std::uint64_t simulated_seeds = 0;
  std::vector<evaluation::ModelGapRow> rows{};
  // Rows whose programs ended too early in the simulation, which have no values there.
  std::vector<std::string> simulated_failures{};
};

// `simulated` is of the same scenario and pipelines.
ModelGapReport model_gap_report(const MeasuredStudy& measured,
                                const evaluation::Results& simulated);

Document model_gap_document(const ModelGapReport& report);
std::string model_gap_json(const ModelGapReport& report);

}  // namespace simbench::reports
