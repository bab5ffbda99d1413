// The answer of `simbench reconstruct`: which pipeline gives the smallest reprojection error,
// whether that is above what a perfect synchronisation leaves, how far apart cameras may be, and
// what is uncertain.
//
//   document.head = paragraphs(reconstruction_answer(results));
#ifndef SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_ANSWER_H_
#define SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_ANSWER_H_

#include "reconstruction/results.h"
#include "reports/text/answer_text.h"

namespace simbench::reports {

AnswerText reconstruction_answer(const reconstruction::ReconstructionResults& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_RECONSTRUCTION_RECONSTRUCTION_ANSWER_H_
