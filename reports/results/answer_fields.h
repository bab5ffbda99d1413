// The answer of a run or of the hosts' clocks alone for programs: its sentences and what is behind
// them (evaluation/answer/answer.h).
//
//   "answer": {"lead", "lines": [{"label", "text"}],        reports/text/answer_json.h
//     "ranked_by": the id of the metric, "ranked": how many pipelines are,
//     "best": null or its name,
//     "not_told_apart": [names], "too_few_seeds": for any verdict; then
//     "seeds_needed": as many would do, else null,
//     "next": null or {"pipeline", "times", "times_interval": null or [low, high]},
//     "failed": [{"pipeline", "reason"}],
//     "limit": null or {"pipeline", "times": best / limit},
//     "known_within": null or the median's 95 % interval as a share of it,
//     "pulses": of the best; null, or where the pulses are known {"due", "exposed", "delivered",
//       "whole", "sets", "mixed_sets"},                     evaluation/scoring/pulse_account.h
//     "levers": null if they were not looked for, or          reports/results/lever_text.h
//       [{"what", "from", "to", ...}], "levers_seeds": over how many seeds}
//
//   const ResultsAnswer answer = results_answer(all_results);
//   const Json fields = answer_with_fields(answer.data, answer.text, nullptr);
#pragma once

#include "evaluation/answer/answer.h"
#include "evaluation/levers/levers.h"
#include "reports/text/answer_text.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

// `levers` may be null.
Json answer_with_fields(const evaluation::Answer& answer, const AnswerText& text,
                        const evaluation::Levers* levers);

}  // namespace simbench::reports
