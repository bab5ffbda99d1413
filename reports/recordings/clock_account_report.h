// The account of clock logs beside a recording (evaluation/diagnosis/clock_account.h) as blocks and
// JSON.
//
// JSON (what does not exist is null):
//   {"hosts": [{"host", "file", "series", "format",
//               "placed": "as_is" | "zone" | "steps" | null, "shift_s",
//               "daylight_saving_s", "points", "first_s", "last_s", "interval_s", "within_ms",
//               "summaries", "changes": [{"at_s", "until_s", "by_ms", "slew", "lasts"}]}],
//    "jumps": [{"host", "cameras", "at_s", "step_ms", "file", "log_step_ms"}],
//    "explained": [{"camera", "host", "stream", "bins", "before_ms", "after_ms", "noise_ms",
//                   "share", "coefficient", "coefficient_low", "coefficient_high"}],
//    "spread": [{"camera", "host", "against", "host_against", "stream", "pairs", "block_s",
//                "constant_ms", "stamps_apart_ms",
//                "parts": {"total" | "exposure" | "stamp" | "delivery" | "host_clock" | "constant"
//                          | "unexplained": {"rms_ms", "low_ms", "high_ms", "share"}}}],
//    "findings": [{"kind", "host", "harm", "text"}]}
// Times are on the scale of the arrivals; of a log that is not placed, on its own.
//
//   for (const Block& block : clock_account_blocks(account)) document.blocks.push_back(block);
#pragma once

#include <vector>

#include "evaluation/diagnosis/clock_account.h"
#include "reports/text/block.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

// Findings, logs, what they explain, the spread of each pair, and the parts of the widest one. None
// for an account without logs.
std::vector<Block> clock_account_blocks(const evaluation::ClockAccount& account);

Json clock_account_json(const evaluation::ClockAccount& account);

}  // namespace simbench::reports
