// Compares two result archives, or pipelines of one archive, seed by seed (`simbench compare`).
//
// A is the reference that B is compared with: the older archive, the pipeline to beat. All numbers
// are of the pairs that both have: the common seeds, the common pipelines. `notes` has the other
// differences (version, commit, seeds, pipelines, parameters of the algorithms). Statistics and
// verdicts are those of evaluation/statistics/paired.h.
//
// Where a scenario draws the load of each pipeline's sessions (Scenario::draws_load()), pipelines
// of one archive share all of a seed but these, and so do archives of scenarios with other names:
// the notes say so. Archives of one scenario share the loads, too.
//
// A row of programs that ended too early has failed: it has no values in a comparison, and the
// notes say why.
//
// All verdicts of one comparison, pipelines times metrics, are corrected for their number together.
//
// Errors: scenarios::InputError, which states the difference and what can be compared instead:
// other worlds (comparison_scenarios.h) unless allowed, no common seed unless paired by index, no
// common pipeline, an unknown name.
//
//   const Archive monday = read_archive("monday");
//   std::cout << plain(comparison_document(compare_with_baseline(monday, "ntp_last_set", {})));
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evaluation/statistics/paired.h"
#include "reports/archive/archive.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"

namespace simbench::reports {

struct ComparisonOptions {
  double smallest_effect = 0.05;         // ComparisonRule::smallest_effect
  bool by_index = false;                 // pairs the n-th seed of A with the n-th of B
  bool different_scenarios = false;      // allows other worlds: compares these, not pipelines
  std::vector<std::string> pipelines{};  // of two archives; empty: all that both have
};

// The values of a metric, one of each pair of seeds; NaN where a seed has none.
struct ComparedValues {
  std::vector<double> a;
  std::vector<double> b;
};

struct ComparedPipeline {
  std::string pipeline_a;
  std::string pipeline_b;
  std::vector<evaluation::PairedComparison> metrics{};  // by Comparison::judged
  std::vector<ComparedValues> values{};                 // behind these
};

struct Comparison {
  std::vector<const evaluation::Metric*> judged{};  // those that any of the rows has
  std::string scenario;
  scenarios::Derivation derivation{};  // of A's scenario
  std::string a;  // in words: "monday (simbench 0.1.0, commit 1234567)", "pipeline ntp of monday"
  std::string b;
  std::string archive_a;  // as they were named
  std::string archive_b;
  bool by_index = false;
  std::uint64_t first_seed_a = 0;
  std::uint64_t first_seed_b = 0;
  std::uint64_t seed_count = 0;
  double smallest_effect = 0;
  bool with_baseline = false;  // each other pipeline compared with one
  std::vector<ComparedPipeline> pipelines;
  std::vector<std::string> notes;
};

// The verdicts of a comparison, which are made and corrected together.
struct VerdictCount {
  std::size_t tests = 0;
  std::size_t equal = 0;         // others, whose values are equal pair by pair: no test is needed
  std::size_t most_pairs = 0;    // of any of them
  std::size_t fewest_pairs = 0;  // with which one of so many can be better or worse

  // How many verdicts better and worse are false, if nothing differs: of Holm's first step, and of
  // tests at 5 % each.
  double expected_false() const { return tests > 0 ? evaluation::kFamilyError : 0; }
  double expected_false_uncorrected() const {
    return evaluation::kFamilyError * static_cast<double>(tests);
  }
};

VerdictCount count_verdicts(const Comparison& comparison);

// Compares pipelines of the same name.
Comparison compare_archives(const Archive& a, const Archive& b, const ComparisonOptions& options);
// Compares two pipelines of one archive.
Comparison compare_pipelines(const Archive& archive, const std::string& a, const std::string& b,
                             const ComparisonOptions& options);
// Compares each other pipeline of the archive (B) with `baseline` (A).
Comparison compare_with_baseline(const Archive& archive, const std::string& baseline,
                                 const ComparisonOptions& options);

// What stands for a line of the comparison: its pipeline, or two of one archive, "b / a".
std::string pair_name(const Comparison& comparison, const ComparedPipeline& pipeline);

// In how many values B is better or worse, and which.
AnswerText comparison_answer(const Comparison& comparison);
// The scenario and its seeds, and what is changed of it: a paragraph each.
std::vector<std::string> scenario_facts(const Comparison& comparison);
// A line for each pipeline and metric, verdicts, notes; with a baseline also in words.
Document comparison_document(const Comparison& comparison);
// The texts of the document.
//
// "better", "too_few_seeds", ...: for programs.
const char* verdict_name(evaluation::Verdict verdict);

// "better"; "worse, by less than 5 %"; "no difference seen: all equal"; "too few seeds: 240
// needed"; where no number of pairs like this can be significant: "too few seeds: 9 needed; higher
// in 5 of 5".
std::string verdict_text(const evaluation::PairedComparison& comparison, double smallest_effect);

// B relative to A: "AMD 205 times smaller [181, 230]", "RMDV 12 % larger [8 %, 15 %]", "recall 100
// % in place of 0 %", "absolute error: no difference seen", "AMD: 190 times smaller, but too few
// seeds: 9 needed, lower in 5 of 5".
std::string effect_words(const evaluation::Metric& metric,
                         const evaluation::PairedComparison& comparison, double smallest_effect);

// schema_version 1; members are only ever added. What does not exist is null.
std::string comparison_json(const Comparison& comparison);
std::string comparison_csv(const Comparison& comparison);

}  // namespace simbench::reports
