// The answer of `simbench diagnose`: what is wrong, the most harmful first, and whether the
// hardware sync works; which camera drifts most and which slips, how small a drift these stamps can
// show, and what no stamp shows.
//
//   document.head = paragraphs(diagnose_answer(diagnosis));
#pragma once

#include "evaluation/diagnosis/diagnose.h"
#include "reports/text/answer_text.h"

namespace simbench::reports {

AnswerText diagnose_answer(const evaluation::Diagnosis& diagnosis);

}  // namespace simbench::reports
