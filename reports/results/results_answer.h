// The answer of a run (evaluation/answer/answer.h): which pipeline is best and by how much, how far
// it is from the limit, whether its sets can be trusted, what a user can change to improve it, and
// what is uncertain. Every sentence is computed from the results; what they do not hold
// has none.
//
//   const AnswerText first = results_answer(all_results).text;
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/answer/answer.h"
#include "evaluation/levers/levers.h"
#include "evaluation/scoring/results.h"
#include "reports/text/answer_text.h"

namespace simbench::reports {

// The answer, what is behind it and its words. The results must outlive it.
struct ResultsAnswer {
  evaluation::Answer data{};
  std::optional<evaluation::Levers> levers{};
  AnswerText text{};
};

// `levers`: of the best pipeline; nothing: they were not looked for, and nothing is said of them.
// `warnings`: of the world (scenarios/loader.h), which are lines of the answer, as those of the
// results and the notes of the best row are; without those that its first sentence has.
// Cost: that of answer_of(), which takes seconds of many rows.
ResultsAnswer results_answer(const evaluation::Results& results,
                             std::optional<evaluation::Levers> levers = {},
                             const std::vector<std::string>& warnings = {});

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
// How far the bench was off beside real rigs under such load; "" without load.
std::string load_text(const evaluation::Results& results);
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
