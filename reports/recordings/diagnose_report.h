// The findings of `simbench diagnose` as blocks and JSON.
//
// JSON, schema_version 1 (what does not exist is null):
//   {"schema_version", "version", "commit", "files",
//    "verdict": {"stream", "status": "works" | "does_not_work" | "cannot_be_told", "reason",
//                "period_ms", "resolution_ppm"},
//    "streams": [like verdict, one per kind of stream],
//    "cameras": [{"camera", "host", "stream", "frames", "span_s", "rate_hz", "period_ms",
//                 "follows": "trigger" | "own_clock" | "other_rate" | "host_or_own" | "unknown",
//                 "period_multiple", "rate_ppm", "rate_sd_ppm", "moves_ms_per_minute", "phase_ms",
//                 "interval_jitter_ms", "on_grid_share", "lost_frames", "never_exposed_frames",
//                 "unknown_frames", "counter_restarts", "counter_jumps", "global_time",
//                 "backward_stamps", "backward_arrivals", "future_stamps", "wraps",
//                 "longest_gap_s", "jumps": [{"at_s", "step_ms", "periods"}]}],
//    "pairs": [{"camera", "stream", "against", "offset_ms", "spread_ms", "moves_ms_per_minute",
//               "runs_free"}],
//    "findings": [{"camera", "stream", "kind", "text"}], "cannot_know": [...]}
// rate_hz is by the host's clock, period_ms by the camera's. Definitions:
// evaluation/diagnosis/diagnose.h.
#pragma once

#include <string>
#include <vector>

#include "evaluation/diagnosis/diagnose.h"
#include "reports/text/block.h"

namespace simbench::reports {

// Its head is the answer (diagnose_answer.h).
Document diagnose_document(const evaluation::Diagnosis& diagnosis);

std::string diagnose_json(const evaluation::Diagnosis& diagnosis,
                          const std::vector<std::string>& files);

// "works", "does not work", "cannot be determined".
const char* sync_status_text(evaluation::SyncStatus status);

}  // namespace simbench::reports
