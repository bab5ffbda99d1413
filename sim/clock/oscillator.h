// The oscillator of a host or of a camera: how far its count is ahead of true time.
//
// An oscillator counts true time with a frequency error y(t) = skew + white noise + random walk.
// What a clock built on it needs is the phase, the integral of y:
//
//   local(t) = t + deviation_ns(t),   deviation_ns(0) = 0
//
// White frequency noise of Allan deviation W at tau = 1 s makes the phase a random walk of variance
// W^2 tau; a random walk of the frequency of K per sqrt(s) has the Allan deviation K sqrt(tau / 3).
// Both are sampled on a fixed grid of true time, exactly (the joint law of the two at the grid
// points); between them the phase is linear. Each step of the grid has random numbers of its own,
// keyed by its index, and the walk starts at true zero in both directions: the values depend
// neither on the order of the queries nor on when the world starts.
//
// Units: nanoseconds; skew as a fraction. The phase is exact to well below 1 ns over days: a rate
// of 1e-9 survives. Complexity: O(1) without noise; otherwise a look-up, after each step of the
// grid between true zero and the query has once been sampled (8 bytes and some 20 ns each).
// Source: DESIGN sections 5 to 7; Riley, "Handbook of Frequency Stability Analysis", NIST SP 1065.
//
//   const OscillatorModel oscillator(scenario.hosts.clock.oscillator, seed, "host3/oscillator");
//   double ahead_ns = oscillator.deviation_ns(engine.now());
#ifndef SIMBENCH_SIM_CLOCK_OSCILLATOR_H_
#define SIMBENCH_SIM_CLOCK_OSCILLATOR_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

class OscillatorModel {
 public:
  // Draws the skew and the noise of the component with this name.
  OscillatorModel(const scenarios::Oscillator& parameters, std::uint64_t run_seed,
                  std::string_view component);
  // An oscillator of this frequency error and no noise.
  explicit OscillatorModel(double skew) : skew_(skew) {}

  // The constant part of the frequency error, as a fraction (1e-6 = 1 ppm).
  double skew() const { return skew_; }

  // Local minus true time elapsed since true zero.
  double deviation_ns(TrueTime t) const {
    const auto since_zero_ns = static_cast<double>(t.time_since_epoch().count());
    const double linear_ns = skew_ * since_zero_ns;
    return step_ns_ == 0 ? linear_ns : linear_ns + noise_ns(t.time_since_epoch().count());
  }

 private:
  // The noise sampled in one direction of time; phases_ns[i] belongs to grid point i or -i.
  struct Walk {
    std::vector<double> phases_ns{0.0};
    double frequency_ppb = 0;  // at the last of these points
  };

  double noise_ns(std::int64_t since_zero_ns) const;
  double grid_phase_ns(std::int64_t index) const;
  // Adds one point to the walk: the step of the grid that begins at grid point `index`.
  void extend(Walk& walk, std::int64_t index, bool forward) const;

  double skew_ = 0;
  std::int64_t step_ns_ = 0;  // of the grid; 0: no noise
  double step_s_ = 0;
  double walk_sigma_ppb_ = 0;  // of the frequency's change in one step
  double phase_sigma_ns_ = 0;  // of the phase's change that the frequencies do not explain
  std::uint64_t run_seed_ = 0;
  ComponentKey wander_key_{""};
  mutable Walk forward_;  // a cache: values are functions of the index alone
  mutable Walk backward_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_CLOCK_OSCILLATOR_H_
