// The baseline of a build: the gated metrics of every pipeline, seed by seed, in a small file
// beside the sources.
//
//   {"schema_version": 1, "kind": "simbench baseline", "version": ..., "commit": ...,
//    "results": "clocks", "from_s", "duration_s": only of clock runs
//    (reports/clocks/clock_report.h), which have other metrics, "scenario": "18cam_6host_45fps",
//    "seeds": {"first": 1, "count": 32}, "margins": {"amd_ms": {"relative": 0.02, "absolute":
//    0.001}, ... one for each metric}, "scenario_digest": ..., "pipelines_digest": ...,
//    "resolved_scenario": {...},
//    "pipelines": [{"pipeline": "oracle", "amd_ms": [in seed order], rmdv_ms, absolute_error_ms,
//                   seed_recall likewise}, ...]}
//
// Metrics that not all results have (of exposures that are steered) are there if a pipeline has
// them.
//
// Margins may be edited by hand. Two digests (comparison_scenarios.h) reveal any other edit, and
// the scenario shows where another one differs. Values have 12 digits, a thousand times finer than
// the tolerated rounding (kRounding in gate.h). A value that does not exist is null.
//
// Errors: scenarios::InputError with file, line and pointer for a file that was cut short, edited
// or written by a newer simbench; OutputError for one that cannot be written.
//
//   write_baseline(make_baseline(read_archive("results")), "reports/baselines/mine.json");
#pragma once

#include <string>
#include <vector>

#include "evaluation/scoring/metrics.h"
#include "reports/archive/archive.h"
#include "reports/comparison/comparison_scenarios.h"

namespace simbench::reports {

inline constexpr int kBaselineSchemaVersion = 1;  // written, and the newest that can be read

struct BaselinePipeline {
  std::string name;
  std::vector<std::vector<double>> values;  // by Baseline::judged, in seed order
};

struct Baseline {
  evaluation::ResultKind kind = evaluation::ResultKind::kCaptures;
  evaluation::ClockPeriod clock_period{};  // of clock runs
  std::string path;                        // as the user stated it; empty without a file
  std::string version;
  std::string commit;
  std::string scenario;
  std::string scenario_json;  // resolved
  SeedRange seeds;
  std::vector<const evaluation::Metric*> judged{};  // those that any pipeline has
  std::vector<evaluation::GateMargin> margins;      // by `judged`
  std::vector<BaselinePipeline> pipelines;
};

// Uses the default margins. Throws InputError for a result without its scenario (a results.json
// alone).
Baseline make_baseline(const Archive& archive);

// Returns the content of the file: a line for each metric of a pipeline, for readable diffs.
std::string baseline_json(const Baseline& baseline);

// The file appears whole or not at all.
void write_baseline(const Baseline& baseline, const std::string& path);

Baseline read_baseline(const std::string& path);

}  // namespace simbench::reports
