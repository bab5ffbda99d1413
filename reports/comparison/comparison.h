// Two result archives, or pipelines of one, compared by seed: what `simbench compare` says.
//
// A is what stands first and what B is held against: the older archive, the pipeline to beat. All
// numbers are of the pairs that both have: the common seeds, the common pipelines. What differs
// besides (version, commit, seeds, pipelines, parameters of the algorithms) is said in `notes`.
// The statistics and the verdicts are those of evaluation/statistics/paired.h.
//
// Errors: scenarios::InputError, which says what differs and what can be compared instead: other
// worlds (comparison_scenarios.h) unless they are asked for, no common seed unless paired by index,
// no common pipeline, an unknown name.
//
//   const Archive monday = read_archive("monday");
//   std::cout << plain(comparison_document(compare_with_baseline(monday, "ntp_last_set", {})));
#ifndef SIMBENCH_REPORTS_COMPARISON_COMPARISON_H_
#define SIMBENCH_REPORTS_COMPARISON_COMPARISON_H_

#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/statistics/paired.h"
#include "reports/archive/archive_reader.h"
#include "reports/text/block.h"

namespace simbench::reports {

struct ComparisonOptions {
  double smallest_effect = 0.05;  // ComparisonRule::smallest_effect
  bool by_index = false;          // the n-th seed of A with the n-th of B, whatever their numbers
  bool different_scenarios = false;  // the question is what the world makes of the same pipeline
  std::vector<std::string> pipelines{};  // of two archives only these; empty: all that both have
};

struct ComparedPipeline {
  std::string pipeline_a;
  std::string pipeline_b;
  std::vector<evaluation::PairedComparison> metrics;  // by evaluation::judged_metrics()
};

struct Comparison {
  std::string scenario;
  std::string a;  // in words: "monday (simbench 0.1.0, commit 1234567)", "pipeline ntp of monday"
  std::string b;
  bool by_index = false;
  std::uint64_t first_seed_a = 0;
  std::uint64_t first_seed_b = 0;
  std::uint64_t seed_count = 0;
  double smallest_effect = 0;
  bool with_baseline = false;  // one pipeline against each of the others
  std::vector<ComparedPipeline> pipelines;
  std::vector<std::string> notes;
};

// Pipelines of the same name.
Comparison compare_archives(const Archive& a, const Archive& b, const ComparisonOptions& options);
// Two pipelines of one archive.
Comparison compare_pipelines(const Archive& archive, const std::string& a, const std::string& b,
                             const ComparisonOptions& options);
// Each other pipeline of the archive (B) against `baseline` (A).
Comparison compare_with_baseline(const Archive& archive, const std::string& baseline,
                                 const ComparisonOptions& options);

// A line for each pipeline and metric, verdicts, notes; with a baseline also in words.
Document comparison_document(const Comparison& comparison);
// schema_version 1; members are only ever added. What does not exist is null.
std::string comparison_json(const Comparison& comparison);
std::string comparison_csv(const Comparison& comparison);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_COMPARISON_COMPARISON_H_
