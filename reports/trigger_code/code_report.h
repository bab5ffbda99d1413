// A trigger's code and what a camera makes of it: the output of `simbench code`.
//
// JSON, schema_version 1; members are only ever added:
//
//   {"schema_version": 1, "kind": "trigger_code", "version", "commit", "scenario",
//    "based_on", "changed", "published_left_out": see state_derivation() (reports/results/json.h),
//    "code": {"kind", "order", "length_pulses", "span_s", "shift_us", "pulses_per_symbol",
//             "rate_hz", "sent_share", "shortest_interval_us", "longest_interval_us"},
//    "search": {"noise_us", "rate_error_ppm", "error_probability" asked for, "places" tried,
//               "found", "wrong", "frames_median", "frames_worst", "seconds_worst",
//               "union_bound" or null},
//    "modes": [{"camera", "mode", "stream", "mode_rate_hz", "follows", "frames_per_s",
//               "takes_from_us", "takes_to_us" or null, "problem"}]}
#pragma once

#include <string>
#include <vector>

#include "algorithms/coded_trigger/code_forecast.h"
#include "reports/text/block.h"
#include "scenarios/trigger_code.h"

namespace simbench::reports {

// A stream of a camera in a sync mode, with the scenario's trigger.
struct CodeMode {
  std::string camera;
  std::string mode;
  std::string stream;
  double mode_rate_hz = 0;
  bool is_own = false;  // the scenario's own mode
  scenarios::CodeLimits limits;
  double frames_per_s = 0;  // if it follows
  std::string problem{};    // why it does not; empty: it does
};

struct TriggerCodeResult {
  std::string scenario;
  scenarios::Derivation derivation{};  // of that scenario
  scenarios::TriggerCodeModel model;
  TriggerCode code;
  CodeDecoderSettings settings;
  CodeForecast forecast;
  std::vector<CodeMode> modes;
};

Document trigger_code_document(const TriggerCodeResult& result);
std::string trigger_code_json(const TriggerCodeResult& result);

}  // namespace simbench::reports
