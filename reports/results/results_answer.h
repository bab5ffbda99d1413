// The answer of a run (evaluation/answer/answer.h): which pipeline is best and by how much, how far
// it is from the limit, what limits it, whether its sets can be trusted, what would improve it
// most, and what is uncertain. Every sentence is computed from the results; what they do not hold
// has none.
//
//   const AnswerText first = results_answer(all_results, nullptr);
#pragma once

#include <string>

#include "evaluation/answer/answer.h"
#include "evaluation/budget/budget.h"
#include "evaluation/scoring/results.h"
#include "reports/text/answer_text.h"

namespace simbench::reports {

// `budget`: of the best pipeline; null: unknown, and nothing is said about it.
AnswerText results_answer(const evaluation::Results& results, const evaluation::Budget* budget);
// The same of an answer that is there already; comparing many rows takes seconds.
AnswerText results_answer(const evaluation::Results& results, const evaluation::Answer& answer,
                          const evaluation::Budget* budget);

// Its sentences that other answers have too; `answer` has a best pipeline.
//
// Who else may be the best, behind its name in the lead: ", with 3 that these seeds cannot tell
// from it,"; "" if there is nobody, or too few seeds for any verdict.
std::string certainty_clause(const evaluation::Answer& answer);
// Which pipelines cannot be told from the best, the next one, and the paper's; "" if there are
// none.
std::string distance_text(const evaluation::Results& results, const evaluation::Answer& answer);
// Which pipelines failed, and why; "" if none did.
std::string failed_text(const evaluation::Answer& answer);
// What these seeds leave open; "" if that is little.
std::string uncertainty_text(const evaluation::Answer& answer);

// Does one need trigger cables? Asked of a table of alignments. A method reaches a spread if the 95
// % quantile of the seeds' 95 % exposure spreads is below it: in nearly all worlds, nearly all
// pulses are exposed that close together. The spreads are 1, 0.1 and 0.01 ms, the methods are the
// pipelines that a rig without cables can run: "No trigger cable is needed for 1 ms or 0.1 ms, but
// for 0.01 ms one is:
// ..."
std::string cables_text(const evaluation::Results& results);
// What the rows that follow a trigger have; "" if there are none.
std::string cable_sentence(const evaluation::Results& results);

}  // namespace simbench::reports
