// Leaderboards as text and JSON (evaluation/run/leaderboard.h): the boards of a scenario whose
// /evaluation/table is "leaderboard", each sorted by absolute error.
//
// JSON: the document of reports/results/json.h with a member "leaderboard": [{"board", "online":
// [...], "offline": [...]}], whose entries are {"pipeline", "error_to_oracle", "amd_to_oracle",
// "error_to_paper", "amd_to_paper"}, each {"median", "p05", "p95"}; null where there is no such
// ratio.
#pragma once

#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/results/results_answer.h"
#include "reports/text/block.h"

namespace simbench::reports {

// The boards, a block each, and the meaning of their columns.
std::vector<Block> board_blocks(const evaluation::Results& results);

// The boards and the notes of the results. `summary`: the scenario's own description.
Document leaderboard_document(const evaluation::Results& results, const std::string& summary);
std::string leaderboard_json(const evaluation::Results& results, const ResultsAnswer& answer);

}  // namespace simbench::reports
