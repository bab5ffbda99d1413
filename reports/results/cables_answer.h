// The answer of a table of alignments: does one need trigger cables?
//
// A method reaches a spread if the 95 % quantile of the seeds' 95 % exposure spreads is below it:
// in nearly all worlds, nearly all pulses are exposed that close together. Asked for 1, 0.1 and
// 0.01 ms, of the pipelines that a rig without cables can run.
//
//   const std::string lead = cables_text(results);
//   // "No trigger cable is needed for 1 ms or 0.1 ms, but for 0.01 ms one is: ..."
#ifndef SIMBENCH_REPORTS_RESULTS_CABLES_ANSWER_H_
#define SIMBENCH_REPORTS_RESULTS_CABLES_ANSWER_H_

#include <string>

#include "evaluation/scoring/results.h"

namespace simbench::reports {

// For which of the three spreads cables are needed, and how many methods reach each. Sentences.
std::string cables_text(const evaluation::Results& results);

// What the rows that follow a trigger have; "" if there are none.
std::string cable_sentence(const evaluation::Results& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RESULTS_CABLES_ANSWER_H_
