// Measured results as a small file beside the program, for comparison with simulations.
//
//   {"schema_version": 1, "date": "2026-11-21", "machine": "...", "scenario": "6node_relay",
//    "commit": "...",
//    "rows": [{"pipeline": "yoon2021_both", "notes": ["repetition 3: ..."],
//              "seeds": [{"seed": 1, "host_error_ms": 0.1, "amd_ms": 0.2, "rmdv_ms": 0.1,
//                         "absolute_error_ms": null}]}]}
//
// A seed is a repetition. A value that does not exist is null; a failed repetition has no seed.
// Unknown members are ignored, so that a file can hold more information.
//
// Errors: scenarios::InputError, with file, line and JSON pointer, for a file that is cut short,
// edited wrongly, of a newer schema or of another scenario; OutputError where it cannot be written.
//
//   write_measured_study("relay.json", measured_study(results, "2026-11-21", "4 cores"));
//   const MeasuredStudy study = read_measured_study("relay.json", "6node_relay");
//   model_gap(results_of(study), simulated);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/model/evidence.h"
#include "evaluation/scoring/results.h"

namespace simbench::reports {

// The values of evaluation::kGapMetrics; NaN: not measured.
struct MeasuredSeed : evaluation::MetricValues<double> {
  std::uint64_t seed = 0;
};

struct MeasuredPipeline {
  std::string pipeline;
  std::vector<MeasuredSeed> seeds;
  std::vector<std::string> notes{};  // failures
};

struct MeasuredStudy {
  std::string date;     // in any format
  std::string machine;  // that was measured on
  std::string scenario;
  std::string commit;     // of the program that measured
  std::string changed{};  // how its world differed from the scenario's (scenarios/derivation.h)
  std::vector<MeasuredPipeline> rows;
};

// Returns the study of results of real captures, with this program's commit.
MeasuredStudy measured_study(const evaluation::Results& results, const std::string& date,
                             const std::string& machine);

// Returns rows with the series of evaluation::kGapMetrics and notes alone.
evaluation::Results results_of(const MeasuredStudy& study);

std::string measured_study_json(const MeasuredStudy& study);
void write_measured_study(const std::string& path, const MeasuredStudy& study);

// `scenario`: the required scenario of the file; empty: any.
MeasuredStudy read_measured_study(const std::string& path, const std::string& scenario);

}  // namespace simbench::reports
