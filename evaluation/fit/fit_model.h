// A fitted rig as a scenario file: what was fitted, over a scenario that gives the rest.
//
// The file states its base by name or path, or is complete by itself where the base is a
// recording's own scenario, which need not be anywhere else. What the fitted tables contain already
// is switched off: jitter common to a host, bursts of load, noise and steps of the stamps; with a
// latency table also what messages cost the hosts at both ends. Faults of the base are left out:
// what they did is in the recording.
//
// "summary" says what each value rests on; fit_evidence() gives the same line by line,
// not_identified() what no fit to these stamps can give.
//
//   const FitModel model = fit_model(fit, input, base, "model.json");
//   reports::write_file("model.json", model.text);
//
// Errors: scenarios::InputError if the base does not bear it (a frame rate that its cameras lack).
#ifndef SIMBENCH_EVALUATION_FIT_FIT_MODEL_H_
#define SIMBENCH_EVALUATION_FIT_FIT_MODEL_H_

#include <optional>
#include <string>
#include <vector>

#include "evaluation/fit/fit.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

struct FitBase {
  scenarios::Scenario scenario;
  std::string stated = {};  // as the file's "base"; empty: the file holds all of the scenario
  // Of a base that is only like the rig: what the recording's frame rate makes of it.
  std::optional<double> rate_hz = {};
  std::optional<double> mode_rate_hz = {};
};

// For recordings of real cameras that state no scenario: the built-in one that is nearest, with the
// cameras' rate at half of the slowest mode that allows it.
FitBase default_base(const FitInput& input);

struct FitModel {
  scenarios::Scenario scenario;
  std::string text;  // of the file
  std::vector<std::string> evidence;
  std::vector<std::string> not_identified;
};

// `path` of the file to come: its stem is the scenario's name, and a base that is a file is stated
// relative to it.
FitModel fit_model(const RigFit& fit, const FitInput& input, const FitBase& base,
                   const std::string& path);

// "/json/pointer: value and evidence" each.
std::vector<std::string> fit_evidence(const RigFit& fit, const FitInput& input);

// `base` gives what is not identified.
std::vector<std::string> not_identified(const RigFit& fit, const FitInput& input,
                                        const scenarios::Scenario& base);

// Of the rates of the hosts' oscillators, from those against the master's, which is one of them;
// and of the first offsets. Nothing where no host has one.
std::optional<double> host_skew_sigma_ppm(const NetworkFit& network);
std::optional<double> initial_offset_sigma_ms(const NetworkFit& network);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_FIT_FIT_MODEL_H_
