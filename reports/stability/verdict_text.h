// Verdicts of masks as sentences and for programs.
//
//   {"mask": "prtc_a", "title": "ITU-T G.8272 PRTC-A", "judgement": "passes", "fails" or
//    "cannot_tell",
//    "limits": [{"label": "MTIE", "quantity": "mtie_ms", "band": "all", "low" or "high",
//                "judgement", "tau_s", "value", "allowed", "share_within", "reason"}]}
//
// The unit of value and allowed is that of the quantity. They are the first beyond the limit, else
// the nearest to it; they and what else there is not are null. Meaning:
// evaluation/stability/mask_verdict.h.
//
//   const evaluation::MaskVerdict verdict{.title = "ITU-T G.8272 PRTC-A"};
//   const std::string sentence = mask_verdict_text(verdict);
#pragma once

#include <string>

#include "evaluation/stability/mask_verdict.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

// "ITU-T G.8272 PRTC-A: fails: MTIE is 42.4 ns at tau 32 s, allowed 33.8 ns."
std::string mask_verdict_text(const evaluation::MaskVerdict& verdict);
Json mask_verdict_json(const evaluation::MaskVerdict& verdict);

}  // namespace simbench::reports
