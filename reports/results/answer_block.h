// The answer of a run (evaluation/answer/answer.h) as one paragraph: which pipeline is best and by
// how much, how far it is from the limit, what limits it, whether its sets can be trusted, what
// would improve it most, and what is uncertain. Every sentence is computed from the results; what
// they do not hold has none.
//
//   const Block first = answer_block(all_results, evaluation::RankedBy::kAmd, nullptr);
#ifndef SIMBENCH_REPORTS_RESULTS_ANSWER_BLOCK_H_
#define SIMBENCH_REPORTS_RESULTS_ANSWER_BLOCK_H_

#include "evaluation/answer/answer.h"
#include "evaluation/budget/budget.h"
#include "evaluation/scoring/results.h"
#include "reports/text/block.h"

namespace simbench::reports {

// `budget`: of the best pipeline; null: unknown, and nothing is said about it.
Block answer_block(const evaluation::Results& results, evaluation::RankedBy ranked_by,
                   const evaluation::Budget* budget);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_ANSWER_BLOCK_H_
