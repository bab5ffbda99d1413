// How often a recommended rig goes wrong (app/rare_sets.h, evaluation/rare) as a block and as JSON.
//
// JSON: [{"event", "bound_ms", "probability", "low", "high", "per_day", "per_day_low",
// "per_day_high", "is_below", "runs", "repeats"}]; what does not exist is null.
#ifndef SIMBENCH_REPORTS_ADVICE_RARE_REPORT_H_
#define SIMBENCH_REPORTS_ADVICE_RARE_REPORT_H_

#include <string>
#include <vector>

#include "evaluation/rare/splitting.h"
#include "reports/text/block.h"
#include "reports/text/json_node.h"

namespace simbench::reports {

struct RareResult {
  std::string event;  // "spread above 0.1 ms"
  double bound_ms = 0;
  double sets_per_day = 0;
  evaluation::RareEstimate estimate{};
};

// Of the rig and pipeline in the heading.
Block rare_block(const std::string& heading, const std::vector<RareResult>& results);
Json rare_json(const std::vector<RareResult>& results);

}  // namespace simbench::reports

#endif  // SIMBENCH_REPORTS_ADVICE_RARE_REPORT_H_
