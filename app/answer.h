// The answer of a simulated run: what it begins with, with an error budget of the best pipeline
// where that is affordable.
//
//   const reports::AnswerText first = run_answer(results, scenario, nullptr);
#pragma once

#include <string>

#include "evaluation/answer/answer.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/scoring/results.h"
#include "reports/text/answer_text.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// Ranks the results by the metric of this id in place of what their scenario says; "" changes
// nothing. Throws scenarios::InputError if none of the rows has a value of it.
void rank_by(const std::string& metric, evaluation::Results& results);

// The budget is over the first seeds of the results, at most four, as many as take at most some 20
// million events; none for programs, whose runs are too slow. The same results have the same
// answer. Throws what evaluation::error_budgets() throws.
reports::AnswerText run_answer(const evaluation::Results& results,
                               const scenarios::Scenario& scenario,
                               const evaluation::Progress& progress);

}  // namespace simbench::app
