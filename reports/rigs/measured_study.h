// Measured results as a small file, to be kept beside the program and compared with simulations.
//
//   {"schema_version": 1, "date": "2026-11-21", "machine": "...", "scenario": "6node_relay",
//    "commit": "...",
//    "rows": [{"pipeline": "yoon2021_both", "notes": ["repetition 3: ..."],
//              "seeds": [{"seed": 1, "host_error_ms": 0.1, "amd_ms": 0.2, "rmdv_ms": 0.1,
//                         "absolute_error_ms": null}]}]}
//
// A seed is a repetition. What does not exist is null; a repetition that failed has no seed.
// Members that are not known are ignored, so that a file can say more about itself.
//
// Errors: scenarios::InputError, with file, line and JSON pointer, for a file that is cut short,
// edited wrongly, of a newer schema or of another scenario; OutputError where it cannot be written.
//
//   write_measured_study("relay.json", measured_study(results, "2026-11-21", "4 cores"));
//   const MeasuredStudy study = read_measured_study("relay.json", "6node_relay");
//   model_gap(results_of(study), simulated);
#ifndef SIMBENCH_REPORTS_RIGS_MEASURED_STUDY_H_
#define SIMBENCH_REPORTS_RIGS_MEASURED_STUDY_H_

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

struct MeasuredSeed {
  std::uint64_t seed = 0;
  double host_error_ms = 0;  // NaN: not measured
  double amd_ms = 0;
  double rmdv_ms = 0;
  double absolute_error_ms = 0;
};

struct MeasuredPipeline {
  std::string pipeline;
  std::vector<MeasuredSeed> seeds;
  std::vector<std::string> notes{};  // what went wrong
};

struct MeasuredStudy {
  std::string date;     // as people write it
  std::string machine;  // the one it was measured on
  std::string scenario;
  std::string commit;  // of the program that measured
  std::vector<MeasuredPipeline> rows;
};

// From results that evaluate() made of real captures; `commit` is this program's.
MeasuredStudy measured_study(const evaluation::Results& results, const std::string& date,
                             const std::string& machine);

// Rows with the four series, notes and no more.
evaluation::Results results_of(const MeasuredStudy& study);

std::string measured_study_json(const MeasuredStudy& study);
void write_measured_study(const std::string& path, const MeasuredStudy& study);

// `scenario`: what the file must be of; empty: any.
MeasuredStudy read_measured_study(const std::string& path, const std::string& scenario);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RIGS_MEASURED_STUDY_H_
