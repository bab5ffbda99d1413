// What a fit rests on, in words: a line for each value, and a line for each that no fit can give.
//
//   for (const std::string& line : fit_evidence(fit, input)) ...
#ifndef SIMBENCH_EVALUATION_FIT_FIT_EVIDENCE_H_
#define SIMBENCH_EVALUATION_FIT_FIT_EVIDENCE_H_

#include <string>
#include <vector>

#include "evaluation/fit/fit.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

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

#endif  // SIMBENCH_EVALUATION_FIT_FIT_EVIDENCE_H_
