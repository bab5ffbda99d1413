// The answer of `simbench sweep`: which pipeline that a rig can run is best at how many points and
// between which values, where two change places, which swept parameter matters most, whether its
// sets can be trusted, and how certain that is.
//
// The metric is that of the ranking (reports/sweep/sweep_ranking.h). Pipelines that need the truth,
// and references, are left out (evaluation/answer/answer.h).
//
//   document.head = paragraphs(sweep_answer(plan, rows));
#ifndef SIMBENCH_REPORTS_SWEEP_SWEEP_ANSWER_H_
#define SIMBENCH_REPORTS_SWEEP_SWEEP_ANSWER_H_

#include <vector>

#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/sweep_score.h"
#include "reports/text/answer_text.h"

namespace simbench::reports {

// `rows`: response(plan, ...). Throws what scenarios::load_scenario_text() throws of the plan's
// scenario.
AnswerText sweep_answer(const evaluation::SweepPlan& plan,
                        const std::vector<evaluation::ResponseRow>& rows);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_SWEEP_SWEEP_ANSWER_H_
