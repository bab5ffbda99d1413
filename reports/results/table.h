// Results for people: the table that `simbench run` prints, for a terminal or as markdown.
//
// Two blocks, each with a row per pipeline: the paper's metrics beside the published values, and
// what only a bench with true time can tell; a third about the gathered sets if the pipelines
// gather in different ways. Rows that are not of a simulation say what ground truth they rest on;
// "unverified" are those without (evaluation/scoring/unverified_scores.h). Below them what went
// wrong, if anything, a legend that a newcomer can start from, the paper's claims with the fraction
// of seeds in which each holds, and what the run cost. About 145 columns wide. Source of the
// definitions: docs/design.md section 8.
//
//   std::cout << table(results, scenario.summary);
#ifndef SIMBENCH_REPORTS_RESULTS_TABLE_H_
#define SIMBENCH_REPORTS_RESULTS_TABLE_H_

#include <string>
#include <string_view>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

// `summary` is the scenario's own line about itself; it says where a scenario is a fit.
std::string table(const evaluation::Results& results, std::string_view summary);
std::string markdown(const evaluation::Results& results, std::string_view summary);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_TABLE_H_
