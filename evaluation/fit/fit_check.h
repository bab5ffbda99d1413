// The quality of a fit: the fitted model is simulated, and the simulation is fitted like the
// recording and compared with it.
//
// The comparison is with the simulator's output, through its buses and clocks, never with the
// fitted tables themselves. It is made twice: the model of the whole recording with that recording,
// and, with enough frames, the model of the first half of each stream with the second half (a
// hold-out).
//
// The distance is Kolmogorov's between the two samples of excess. No stamp shows the constant part
// of a delay, so the samples are put on one lowest value, one lower quartile or one median,
// whichever brings them closest; they are rounded to 10 us, which is coarser than the steps of
// stamps that make a lattice of them. Two samples of one distribution exceed the limit in 5 % of
// all cases at most, for sizes reduced by the correlation of successive frames, n (1 - r) / (1 +
// r). The samples of a hold-out differ more if the rig changed between the halves.
//
// Verdicts: the distance against its limit; the correlations and, camera by camera, the drifts, a
// difference against its standard error (Welch's t, 5 % for all of these together); the shares of
// lost frames agree if their 95 % intervals meet. The drift that a hold-out judges is the one
// fitted to the first half: the simulation adds nothing but noise to it.
//
// Trust: the model reproduces its own recording's delays, and predicts all of the held-out half. A
// recording without a second clock shows neither.
//
// The drift of simulated cameras is relative to true time: a recording cannot show its hosts' own
// rates, so both sides omit them.
//
//   const FitStudy study = study_fit(input, base, "model.json", sim::make_simulation);
//   print(study.trust.text, study.whole.ks, study.hold_out->ks);
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
  std::vector<std::optional<FittedValue>> skew_ppm;  // by camera
  std::optional<FittedValue> correlation;
  std::optional<DropFit> drops;  // nothing: no stream counts its frames
};

// One thing that the model should reproduce.
struct FitVerdict {
  std::string what;  // "delays", "correlation", "drift", "losses"
  bool agrees = true;
  std::string text;  // a sentence's part, with the numbers
};

struct FitCheck {
  FitSide recorded;
  FitSide simulated;
  double ks = 0;
  double ks_limit = 0;
  std::vector<FitVerdict> verdicts;  // drifts camera by camera
};

struct FitTrust {
  bool held_out = false;  // a half was held back
  // The model predicts that half; false: something speaks against it; nothing: not known.
  std::optional<bool> holds = {};
  std::string text;  // a sentence
};

struct FitStudy {
  FitModel model;
  FitCheck whole;
  std::optional<FitCheck> hold_out;  // nothing: no stream has 2 kFewestFrames frames
  FitTrust trust;
};

// Simulates the model and fits the result: `pulses` frames of each camera, in true time.
RigFit simulate_fit(const scenarios::Scenario& model, std::int64_t pulses,
                    const WorldFactory& make_world, std::uint64_t seed = 1);

// `fitted`: what the model was made from. `cameras`: their names. As many frames are simulated as
// were recorded, kMostChecked of each camera at most, or `most_pulses`.
inline constexpr std::int64_t kMostChecked = 200'000;
FitCheck check_fit(const RigFit& recorded, const RigFit& fitted, const scenarios::Scenario& model,
                   const std::vector<std::string>& cameras, const WorldFactory& make_world,
                   std::int64_t most_pulses = kMostChecked);

// Fits, and checks both ways. Errors: FitError, scenarios::InputError.
FitStudy study_fit(const FitInput& input, const FitBase& base, const std::string& path,
                   const WorldFactory& make_world);

}  // namespace simbench::evaluation
