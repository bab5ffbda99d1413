// Holds a result to a baseline (`simbench gate`).
//
// Exact mode, for pinned seeds: requires the seeds and the world of the baseline. Reports every
// change beyond rounding. A check fails if the metric's table value
// (evaluation::Metric::table_value) is worse by more than its margin, the larger of a share and a
// step, or if a seed lost its value. There is no inference: equal code gives equal numbers.
//
// Statistical mode, for 32 or more seeds of any numbers: paired by seed with at least 32 common
// seeds, else by index, as independent runs. A check fails only if the mean is worse by more than
// the margin and its Student's t interval excludes zero after Holm's correction over all checks of
// the gate (evaluation/statistics/paired.h): fewer than one of twenty gates raises a false alarm.
// Lost values fail here too if the seeds are the same, else if more than half are lost.
//
// In both modes a pipeline of the baseline that is missing in the result fails; an additional one
// is noted, and so are differences of the algorithms and pipelines that failed
// (evaluation/answer/standing.h), whose small errors say little. The speed of the run does not
// matter.
//
// Errors: scenarios::InputError for a result that cannot be compared with this baseline, with the
// difference and the remedy.
//
//   const GateReport report = gate(read_archive("results"), read_baseline("mine.json"), {});
//   if (!report.passed()) std::cout << gate_text(report);
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "evaluation/statistics/paired.h"
#include "reports/archive/archive.h"
#include "reports/comparison/baseline.h"

namespace simbench::reports {

// The relative difference that counts as rounding: digits of a baseline, contraction by a compiler.
inline constexpr double kRounding = 1e-9;
inline constexpr std::uint64_t kFewestGateSeeds = 32;  // in statistical mode

enum class GateMode : std::uint8_t { kExact, kStatistical };

enum class GateOutcome : std::uint8_t {
  kSame,      // equal except for rounding in every seed
  kChanged,   // within the margin
  kBetter,    // by more than the margin
  kPossible,  // statistical: worse by more than the margin, but not significantly
  kFailed,
};

// One metric of one pipeline.
struct GateCheck {
  std::string pipeline;
  const evaluation::Metric* metric = nullptr;
  GateOutcome outcome = GateOutcome::kSame;
  // Table values in exact mode, means of the pairs in statistical mode; NaN: no seed has a value.
  double baseline = std::numeric_limits<double>::quiet_NaN();
  double value = std::numeric_limits<double>::quiet_NaN();
  double margin = 0;              // in the metric's unit
  std::size_t changed_seeds = 0;  // pairs that differ beyond rounding
  std::size_t lost_seeds = 0;     // with a value before and none now
  // Statistical mode: the mean difference with its corrected interval and p-value.
  evaluation::Estimate difference;
  double confidence = 0;  // of that interval
  double adjusted_p = 1;
};

struct GateReport {
  GateMode mode = GateMode::kExact;
  std::string scenario;
  scenarios::Derivation derivation{};  // of the result
  std::string result_path;
  std::string baseline_path;
  std::string baseline_version;
  std::string baseline_commit;
  SeedRange seeds;           // the compared seeds of the result
  SeedRange baseline_seeds;  // likewise
  bool by_index = false;
  std::vector<GateCheck> checks;  // by pipeline and metric, in the baseline's order
  std::vector<std::string> vanished_pipelines;
  std::vector<std::string> notes;
  std::vector<std::string> reproduce;  // commands, in order

  bool passed() const;
  std::size_t count(GateOutcome outcome) const;
};

GateReport gate(const Archive& result, const Baseline& baseline, GateMode mode);

// One sentence about a check: metric, pipeline, scenario, seeds, old, new and allowed value.
std::string check_text(const GateReport& report, const GateCheck& check);
// "same", "changed", "better", "possibly_worse", "failed".
const char* outcome_name(GateOutcome outcome);

std::string gate_text(const GateReport& report);
// Markdown for a CI's page of a change: a title with the scenario and the verdict, what failed, the
// table of what changed, notes, commands.
std::string gate_markdown(const GateReport& report);
// schema_version 1; members are only ever added. What does not exist is null.
std::string gate_json(const GateReport& report);

// Returns the report as JUnit XML, which CI services show beside a change: a suite for the gate, a
// case for each metric of each pipeline, a failure with its numbers and the commands that repeat
// it. There is no standard; this is the part that GitLab, Jenkins and the common GitHub actions
// read: testsuites, testsuite, testcase (classname, name, time), failure (message, text).
std::string gate_junit(const GateReport& report);

}  // namespace simbench::reports
