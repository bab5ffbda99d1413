// A fitted rig as a scenario file: the fitted values over a base scenario.
//
// The file names its base by name or path, or is complete if the base is a recording's own
// scenario, which may exist nowhere else. Effects that the fitted tables contain are switched off:
// jitter common to a host, bursts of load, noise and steps of the stamps; with a latency table also
// the cost of messages on the hosts at both ends. Faults of the base are omitted: their effects are
// in the recording.
//
// "summary" has the evidence for each value. What the recording has and the model lacks is said in
// `left_out`; a camera whose rate was not found has the mean rate of the others.
//
//   const FitModel model = fit_model(fit, input, base, "model.json");
//   reports::write_file("model.json", model.text);
//
// Errors: scenarios::InputError if the base does not support it.
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
  // The fast camera: a D435 in its mode of 848 x 100 pixels at 300 Hz.
  bool fast_camera = false;
  std::string left_out = {};                // a line, if the recording's rate is not the model's
  std::vector<std::string> recording = {};  // its paths, which the file states
};

// Returns the nearest built-in scenario, for recordings of real cameras without one, with the
// cameras' rate (that of the slowest stream with kFewestFrames) at half of the slowest mode that
// allows it: of the base's cameras, else of the fast camera. Beyond that too, the fastest rate.
FitBase default_base(const FitInput& input);

struct FitModel {
  scenarios::Scenario scenario;
  std::string text;  // of the file
  // A line "/json/pointer: value and evidence" for each fitted value.
  std::vector<std::string> evidence;
  // A line for each value that comes from the base.
  std::vector<std::string> not_identified;
  // A line for each thing that the recording has and the model does not.
  std::vector<std::string> left_out;
};

// `path`: of the future file; its stem is the scenario's name, and a base that is a file is stated
// relative to it.
FitModel fit_model(const RigFit& fit, const FitInput& input, const FitBase& base,
                   const std::string& path);

}  // namespace simbench::evaluation
