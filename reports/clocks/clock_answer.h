// The answer of `simbench clocks`: which host_sync keeps the hosts' clocks closest together and by
// how much, from when on they are in sync, whether the rest is constant or moves, what happens
// without the master, what it costs in packets, and what is uncertain. Ranked by the mean spread in
// time (evaluation/answer/answer.h).
//
//   document.head = paragraphs(clock_answer(clocks));
#ifndef SIMBENCH_REPORTS_CLOCKS_CLOCK_ANSWER_H_
#define SIMBENCH_REPORTS_CLOCKS_CLOCK_ANSWER_H_

#include "evaluation/scoring/results.h"
#include "reports/text/answer_text.h"

namespace simbench::reports {

// `results`: of ResultKind::kClockRuns.
AnswerText clock_answer(const evaluation::Results& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_CLOCKS_CLOCK_ANSWER_H_
