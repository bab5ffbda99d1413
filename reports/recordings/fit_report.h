// A fit to a recording as text or JSON: whether to trust it, the fitted values with their evidence,
// what was left out, and the agreement of the simulated model with the recording.
//
// JSON: {"schema_version", "version", "commit", "inputs", "capture", "base", "model", "trust":
// {"holds": the model predicts, false: something speaks against it, "held_out": a half was held
// back, "text"}, "evidence": [text], "not_identified": [text], "left_out": [text], "checks":
// [{"check": "whole" | "hold_out", "ks", "ks_limit", "verdicts": [{"what": "delays" | "correlation"
// | "drift" | "losses", "agrees", "text"}], "excess_ms": [{"probability", "recorded",
// "simulated"}], "skew_ppm": [{"camera", "recorded": {"value", "error": standard error, "low",
// "high": of the 95 % interval}, "simulated"}], "correlation": {"recorded", "simulated"},
// "drop_share": {"recorded": {"value", "low", "high"}, "simulated"}, "frames": {"recorded",
// "simulated"}}]}; what does not exist is null.
#pragma once

#include <string>
#include <vector>

#include "evaluation/fit/fit_check.h"
#include "reports/text/block.h"

namespace simbench::reports {

struct FitReport {
  std::vector<std::string> inputs;
  std::string capture;               // of a recording folder; else empty
  std::string base;                  // the base scenario
  std::string model;                 // the file
  std::vector<std::string> cameras;  // names
  evaluation::FitStudy study;
};

// A recording beside what a model of it simulates; `cameras`: their names.
Block fit_check_block(const std::string& heading, const evaluation::FitCheck& check,
                      const std::vector<std::string>& cameras);

std::string fit_table(const FitReport& report);
std::string fit_json(const FitReport& report);

}  // namespace simbench::reports
