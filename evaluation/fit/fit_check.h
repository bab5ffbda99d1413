// How good a fit is: the fitted model is simulated, the simulation is fitted like the recording,
// and both are put side by side.
//
// Nothing is taken from the tables themselves: what the simulator makes of a model, through its
// buses and clocks, is what is compared. Twice: the model of the whole recording against that
// recording, and, where there are frames enough, the model of the first half of each stream against
// the second half, which it was not fitted to (a hold-out).
//
// The distance is Kolmogorov's between the two samples of excess; the limit is what two samples of
// one distribution exceed in 5 % of all cases, for sizes reduced by the correlation of successive
// frames, n (1 - r) / (1 + r). The samples of a hold-out differ more than that if the rig itself
// changed between the halves.
//
// The drift of simulated cameras is against true time: a recording cannot show its hosts' own
// rates, so they are left out of both sides.
//
//   const FitStudy study = study_fit(input, base, "model.json", sim::make_simulation);
//   print(study.whole.ks, study.hold_out->ks);
#ifndef SIMBENCH_EVALUATION_FIT_FIT_CHECK_H_
#define SIMBENCH_EVALUATION_FIT_FIT_CHECK_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/budget/budget.h"
#include "evaluation/fit/fit.h"
#include "evaluation/fit/fit_model.h"

namespace simbench::evaluation {

inline constexpr std::array<double, 8> kFitQuantiles = {0.01, 0.05, 0.25, 0.5,
                                                        0.75, 0.95, 0.99, 0.999};

// What is compared of a recording, or of a simulation.
struct FitSide {
  std::int64_t frames = 0;
  std::array<double, kFitQuantiles.size()> excess_ms{};
  std::vector<FittedValue> skew_ppm;  // by camera
  std::optional<FittedValue> correlation;
  double drop_share = 0;
  Interval drop_interval;
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

// The model as simulated: `pulses` frames of each camera, in true time.
RigFit simulate_fit(const scenarios::Scenario& model, std::int64_t pulses,
                    const WorldFactory& make_world, std::uint64_t seed = 1);

FitCheck check_fit(const RigFit& recorded, const scenarios::Scenario& model,
                   const WorldFactory& make_world);

// Fits, and checks both ways. Errors: FitError, scenarios::InputError.
FitStudy study_fit(const FitInput& input, const FitBase& base, const std::string& path,
                   const WorldFactory& make_world);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_FIT_FIT_CHECK_H_
