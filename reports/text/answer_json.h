// An answer for programs, as each command that answers has it in its JSON:
//
//   "answer": null, or {"lead": ..., "lines": [{"label": "Sets", "text": ...}, ...]}
//
// Commands add the fields behind the sentences (reports/results/answer_fields.h).
#pragma once

#include "reports/text/answer_text.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

Json answer_json(const AnswerText& answer);

}  // namespace simbench::reports
