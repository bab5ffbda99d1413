// The bench beside real rigs whose truth was measured: the output of `simbench reality`.
//
// JSON, schema_version 1; members are only ever added:
//
//   {"schema_version": 1, "kind": "reality", "version", "commit",
//    "recordings": [{"name", "title", "source", "instrument", "duration_s", "from_s",
//       "rows": [{"name", "scenario", "pipeline", "host", "quantity",
//                 "measured_us": {"median", "least", "largest"},
//                 "predicted_us": {"median", "least", "largest", "values": [in seed order]},
//                 "ratio": of the medians, "factor", "is_within", "used_for": "" if it counts,
//                 "spans": [{"what", "pointer", "value", "predicted_us"}]}],
//       "unknown": [{"what", "pointer", "nominal", "source"}]}]}
#pragma once

#include <string>
#include <vector>

#include "evaluation/reality/reality.h"
#include "reports/text/block.h"
#include "scenarios/reality.h"

namespace simbench::reports {

struct RealityResult {
  const scenarios::RealRecording* recording = nullptr;
  std::vector<evaluation::RealityRow> rows{};
};

// How many of the rows that count are within their factor, then a table for each recording and
// what is unknown of it.
Document reality_document(const std::vector<RealityResult>& results);
std::string reality_json(const std::vector<RealityResult>& results);

}  // namespace simbench::reports
