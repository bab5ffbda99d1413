// A fitted rig as a scenario file: the fitted values over a base scenario.
//
// The file names its base by name or path, or is complete if the base is a recording's own
// scenario, which may exist nowhere else. Effects that the fitted tables contain are switched off:
// jitter common to a host, bursts of load, noise and steps of the stamps; with a latency table also
// the cost of messages on the hosts at both ends. Faults of the base are omitted: their effects are
// in the recording.
//
// "summary" has the evidence for each value.
//
//   const FitModel model = fit_model(fit, input, base, "model.json");
//   reports::write_file("model.json", model.text);
//
// Errors: scenarios::InputError if the base does not support it (a frame rate that its cameras
// lack).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/fit/fit.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

struct FitBase {
  scenarios::Scenario scenario;
  std::string stated = {};  // as the file's "base"; empty: the file holds the whole scenario
  // Replacements by the recording's frame rate, for a base that only resembles the rig.
  std::optional<double> rate_hz = {};
  std::optional<double> mode_rate_hz = {};
};

// Returns the nearest built-in scenario, for recordings of real cameras without one, with the
// cameras' rate at half of the slowest mode that allows it.
FitBase default_base(const FitInput& input);

struct FitModel {
  scenarios::Scenario scenario;
  std::string text;  // of the file
  // A line "/json/pointer: value and evidence" for each fitted value.
  std::vector<std::string> evidence;
  // A line for each value that comes from the base.
  std::vector<std::string> not_identified;
};

// `path`: of the future file; its stem is the scenario's name, and a base that is a file is stated
// relative to it.
FitModel fit_model(const RigFit& fit, const FitInput& input, const FitBase& base,
                   const std::string& path);

}  // namespace simbench::evaluation
