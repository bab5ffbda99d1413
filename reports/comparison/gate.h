// Holds a result to a baseline: what `simbench gate` decides.
//
// Exact, for pinned seeds: the seeds and the world of the baseline are demanded. Whatever changed
// beyond rounding is reported; a check fails if the metric's table value
// (evaluation::Metric::table_value) is worse by more than its margin, the larger of a share and a
// step, or if a seed that had a value has none now. Nothing is inferred: equal code gives equal
// numbers.
//
// Statistical, for 32 or more seeds of any numbers: paired by seed if at least 32 are common, else
// by index, as independent runs. A check fails only if the mean is worse by more than the margin
// and its Student's t interval excludes zero after Holm's correction over all checks of the gate
// (evaluation/statistics/paired.h): a gate cries wolf in fewer than one of twenty runs. Values
// that vanished fail here too if the seeds are the same, or if none is left.
//
// In both a pipeline of the baseline that the result lacks fails; one that it has more is noted.
// The algorithms may differ, which is what a gate is for, and this is noted. How fast the run was
// does not matter.
//
// Errors: scenarios::InputError for a result that cannot be held to this baseline, saying what
// differs and what to do.
//
//   const GateReport report = gate(read_archive("results"), read_baseline("mine.json"), {});
//   if (!report.passed()) std::cout << gate_text(report);
#ifndef SIMBENCH_REPORTS_COMPARISON_GATE_H_
#define SIMBENCH_REPORTS_COMPARISON_GATE_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/statistics/paired.h"
#include "reports/archive/archive_reader.h"
#include "reports/archive/baseline.h"
#include "reports/comparison/comparison_scenarios.h"

namespace simbench::reports {

// Of two numbers that are equal but for rounding: a baseline's digits, a compiler that contracts.
inline constexpr double kRounding = 1e-9;
inline constexpr std::uint64_t kFewestGateSeeds = 32;  // of the statistical gate

enum class GateMode : std::uint8_t { kExact, kStatistical };

enum class GateOutcome : std::uint8_t {
  kSame,      // equal but for rounding in every seed
  kChanged,   // within the margin
  kBetter,    // by more than the margin
  kPossible,  // statistical: worse by more than the margin, but as far as is known by chance
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
  std::size_t lost_seeds = 0;     // had a value and have none
  // Statistical mode: the mean difference with its corrected interval and p-value.
  evaluation::Estimate difference;
  double confidence = 0;  // of that interval
  double adjusted_p = 1;
};

struct GateReport {
  GateMode mode = GateMode::kExact;
  std::string scenario;
  std::string result_path;
  std::string baseline_path;
  std::string baseline_version;
  std::string baseline_commit;
  SeedRange seeds;           // of the result, those that were compared
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

// One sentence about a check: metric, pipeline, scenario, seeds, what it was, is and may be.
std::string check_text(const GateReport& report, const GateCheck& check);
// "same", "changed", "better", "possibly_worse", "failed".
const char* outcome_name(GateOutcome outcome);

std::string gate_text(const GateReport& report);
// schema_version 1; members are only ever added. What does not exist is null.
std::string gate_json(const GateReport& report);

// A gate's report as JUnit XML, which CI services show beside a change: a suite for the gate, a
// case for each metric of each pipeline, a failure with its numbers and the commands that repeat
// it.
//
// There is no standard; written is the part that GitLab, Jenkins and the common GitHub actions
// read: testsuites, testsuite, testcase (classname, name, time), failure (message, text).
std::string gate_junit(const GateReport& report);

// Text for an attribute or an element of XML 1.0: what it cannot hold is a question mark.
std::string xml_text(std::string_view text);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_COMPARISON_GATE_H_
