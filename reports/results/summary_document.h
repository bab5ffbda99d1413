// Results for people in a hurry: what `simbench run` prints by default, on one screen.
//
// The answer (reports/results/results_answer.h), what the scenario is, and one table with a row per
// pipeline and the metrics that name it (TablePlaces::summary), each value in the unit
// that fits it. A leaderboard has a short table for each board; a table of alignments has the
// metrics of exposures, in order of their spread. Whatever failed is said, and
// where the rest is. The first of many pipelines are shown, in order of the answer's metric for
// leaderboards, else in the scenario's order.
//
//   const AnswerText answer = results_answer(all_results).text;
//   std::cout << plain(summary_document(all_results, {.summary = scenario.summary}, answer));
#pragma once

#include <string>
#include <vector>

#include "evaluation/scoring/results.h"
#include "reports/text/answer_text.h"
#include "reports/text/block.h"
#include "scenarios/choices.h"

namespace simbench::reports {

struct SummaryOptions {
  std::string summary{};  // the scenario's own description
  scenarios::TableKind table = scenarios::TableKind::kPipelines;
};

// Its tables.
std::vector<Block> summary_blocks(const evaluation::Results& results, scenarios::TableKind table);

// The default output. `answer` becomes its first paragraph.
Document summary_document(const evaluation::Results& results, const SummaryOptions& options,
                          const AnswerText& answer);

// The answer alone, with what failed: --quiet.
Document quiet_document(const evaluation::Results& results, const AnswerText& answer);

}  // namespace simbench::reports
