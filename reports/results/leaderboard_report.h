// A leaderboard for people and for scripts (evaluation/run/leaderboard.h): the boards of a scenario
// whose /evaluation/table is "leaderboard", each sorted by absolute error.
//
// JSON: the document of reports/results/json.h with a member "leaderboard": [{"board", "online":
// [...], "offline": [...]}], whose entries are {"pipeline", "error_to_oracle", "amd_to_oracle",
// "error_to_paper", "amd_to_paper"}, each {"median", "p05", "p95"}; null where there is no such
// ratio.
#ifndef SIMBENCH_REPORTS_RESULTS_LEADERBOARD_REPORT_H_
#define SIMBENCH_REPORTS_RESULTS_LEADERBOARD_REPORT_H_

#include <string>
#include <string_view>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

std::string leaderboard_table(const evaluation::Results& results, std::string_view summary);
std::string leaderboard_markdown(const evaluation::Results& results, std::string_view summary);
std::string leaderboard_json(const evaluation::Results& results);

// What unequal links cost two-way methods; empty if they are equal.
std::string asymmetry_line(const evaluation::Results& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_LEADERBOARD_REPORT_H_
