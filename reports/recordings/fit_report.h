// A fit to a recording as text or JSON: the fitted values with their evidence, and the agreement of
// the simulated model with the recording.
//
// JSON: {"schema_version", "version", "commit", "inputs", "capture", "base", "model", "evidence":
// [text], "not_identified": [text], "checks": [{"check": "whole" | "hold_out", "ks", "ks_limit",
// "excess_ms": [{"probability", "recorded", "simulated"}], "skew_ppm": [{"camera", "recorded":
// {"value", "error"}, "simulated"}], "correlation": {"recorded", "simulated"}, "drop_share":
// {"recorded", "simulated"}, "frames": {"recorded", "simulated"}}]}; what does not exist is null.
#pragma once

#include <string>
#include <vector>

#include "evaluation/fit/fit_check.h"

namespace simbench::reports {

struct FitReport {
  std::vector<std::string> inputs;
  std::string capture;               // of a recording folder; else empty
  std::string base;                  // the base scenario
  std::string model;                 // the file
  std::vector<std::string> cameras;  // names
  evaluation::FitStudy study;
};

std::string fit_table(const FitReport& report);
std::string fit_json(const FitReport& report);

}  // namespace simbench::reports
