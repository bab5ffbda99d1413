// The answer of a simulated run: what it begins with, with what a user can change to improve the
// best pipeline where looking for it is affordable.
//
//   const reports::ResultsAnswer first = run_answer(results, scenario, {}, nullptr);
#pragma once

#include <string>

#include "evaluation/run/evaluate.h"
#include "evaluation/scoring/results.h"
#include "reports/results/results_answer.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// Ranks the results by the metric of this id in place of what their scenario says; "" changes
// nothing. Throws scenarios::InputError if none of the rows has a value of it.
void rank_by(const std::string& metric, evaluation::Results& results);

struct AnswerOptions {
  bool levers = true;
  unsigned jobs = 0;  // threads; 0: as many as there are cores
};

// The levers: evaluation/levers/levers.h; none of programs, whose runs are too slow, and none in
// worlds that are too large. The same results have the same answer. Throws what
// evaluation::find_levers() throws.
reports::ResultsAnswer run_answer(const evaluation::Results& results,
                                  const scenarios::Scenario& scenario, const AnswerOptions& options,
                                  const evaluation::Progress& progress);

}  // namespace simbench::app
