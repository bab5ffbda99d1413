// What a user can change, in words and for programs (evaluation/levers/levers.h).
//
//   "With device_time regression_30_exposure_corrected: AMD from 2.92 to 1.89 ms."
//
// In JSON an array, the most effective first:
//
//   [{"what": "equal exposures (no auto-exposure)", "pipeline": "yoon2021_both",
//     "sets": {"/cameras/exposure_host_periods": "0"}, "metric": "amd_ms", "from": 2.92, "to": 1.9,
//     "difference": mean over the seeds, "interval": [low, high] of it,
//     "missing_from": share of the pulses due that is not found whole, "missing_to",
//     "options": "--pipelines yoon2021_both --set /cameras/exposure_host_periods=0"}]
//
// `options` added to the command of the run repeat the lever.
#pragma once

#include <cstdint>
#include <string>

#include "evaluation/levers/levers.h"
#include "evaluation/scoring/ranked_by.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

// The most effective three, or that nothing helps.
std::string levers_text(const evaluation::Levers& levers, evaluation::RankedBy ranked_by,
                        std::uint64_t seeds_of_run);

Json levers_json(const evaluation::Levers& levers, evaluation::RankedBy ranked_by);

}  // namespace simbench::reports
