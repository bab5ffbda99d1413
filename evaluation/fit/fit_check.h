// The quality of a fit: the fitted model is simulated, and the simulation is fitted like the
// recording and compared with it.
//
// The comparison is with the simulator's output, through its buses and clocks, never with the
// fitted tables themselves. It is made twice: the model of the whole recording with that recording,
// and, with enough frames, the model of the first half of each stream with the second half (a
// hold-out).
//
// The distance is Kolmogorov's between the two samples of excess. Two samples of one distribution
// exceed the limit in 5 % of all cases, for sizes reduced by the correlation of successive frames,
// n (1 - r) / (1 + r). The samples of a hold-out differ more if the rig changed between the halves.
//
// The drift of simulated cameras is relative to true time: a recording cannot show its hosts' own
// rates, so both sides omit them.
//
//   const FitStudy study = study_fit(input, base, "model.json", sim::make_simulation);
//   print(study.whole.ks, study.hold_out->ks);
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/fit/fit.h"
#include "evaluation/fit/fit_model.h"
#include "evaluation/run/evaluate.h"

namespace simbench::evaluation {

inline constexpr std::array<double, 8> kFitQuantiles = {0.01, 0.05, 0.25, 0.5,
                                                        0.75, 0.95, 0.99, 0.999};

// The compared values of a recording or a simulation.
struct FitSide {
  std::int64_t frames = 0;
  std::array<double, kFitQuantiles.size()> excess_ms{};
  std::vector<FittedValue> skew_ppm;  // by camera
  std::optional<FittedValue> correlation;
  std::optional<DropFit> drops;  // nothing: no stream counts its frames
};

struct FitCheck {
  FitSide recorded;
  FitSide simulated;
  double ks = 0;
  double ks_limit = 0;
};

struct FitStudy {
  FitModel model;
  FitCheck whole;
  std::optional<FitCheck> hold_out;  // nothing: a stream with fewer than 2 kFewestFrames frames
};

// Simulates the model and fits the result: `pulses` frames of each camera, in true time.
RigFit simulate_fit(const scenarios::Scenario& model, std::int64_t pulses,
                    const WorldFactory& make_world, std::uint64_t seed = 1);

FitCheck check_fit(const RigFit& recorded, const scenarios::Scenario& model,
                   const WorldFactory& make_world);

// Fits, and checks both ways. Errors: FitError, scenarios::InputError.
FitStudy study_fit(const FitInput& input, const FitBase& base, const std::string& path,
                   const WorldFactory& make_world);

}  // namespace simbench::evaluation
