// The oscillator of a host or of a camera: how far its count is ahead of true time.
//
// An oscillator counts true time with a frequency error
//
//   y(t) = skew + white noise + flicker + random walk + ramp + self-heating
//
// What a clock built on it needs is the phase, the integral of y:
//
//   local(t) = t + deviation_ns(t),   deviation_ns(0) = 0
//
// White frequency noise of Allan deviation W at tau = 1 s makes the phase a random walk of variance
// W^2 tau; a random walk of the frequency of K per sqrt(s) has the Allan deviation K sqrt(tau / 3).
// Both are sampled exactly (the joint law of the two) on a fixed grid of true time of
// wander_step_ms, and the phase is linear in between: the Allan deviation is the configured one
// from that step on. Flicker has a grid of its own (sim/clock/flicker_noise.h): its floor is flat
// from 0.1 s to 1000 s. Each step of a grid has random numbers of its own, keyed by its index, and
// the walks start at true zero in both directions: values depend neither on the order of the
// queries nor on when the world starts.
//
// The ramp R begins at true zero: R t^2 / 2. Self-heating of H with time constant T begins when the
// device is switched on, s seconds before t: y = H (1 - exp(-s / T)).
//
// Units: nanoseconds; skew as a fraction. The phase is exact to well below 1 ns over days: a rate
// of 1e-9 survives. Complexity: O(1) without noise; otherwise a look-up, after each step of the
// grid between true zero and the query has once been sampled (8 bytes and some 20 ns each, some
// 120 ns with flicker).
// Source: docs/design.md sections 5 to 7; Riley, "Handbook of Frequency Stability Analysis", NIST
// SP 1065.
//
//   const OscillatorModel oscillator(scenario.hosts.clock.oscillator, seed, "host3/oscillator");
//   double ahead_ns = oscillator.deviation_ns(engine.now());
#ifndef SIMBENCH_SIM_CLOCK_OSCILLATOR_H_
#define SIMBENCH_SIM_CLOCK_OSCILLATOR_H_

#include <cstdint>
#include <memory>
#include <string_view>

#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/clock/flicker_noise.h"
#include "sim/clock/grid_walk.h"
#include "sim/engine/random.h"

namespace simbench::sim {

class OscillatorModel {
 public:
  // Draws the skew and the noise of the component with this name.
  OscillatorModel(const scenarios::Oscillator& parameters, std::uint64_t run_seed,
                  std::string_view component, TrueTime switched_on = TrueTime{});
  // An oscillator of this frequency error and no noise.
  explicit OscillatorModel(double skew) : skew_(skew) {}

  // The constant part of the frequency error, as a fraction (1e-6 = 1 ppm).
  double skew() const { return skew_; }

  // A measured skew in place of the drawn one.
  void set_skew(double skew) { skew_ = skew; }

  // Local minus true time elapsed since true zero.
  double deviation_ns(TrueTime t) const {
    const double linear_ns = skew_ * static_cast<double>(t.time_since_epoch().count());
    return is_steady_ ? linear_ns : linear_ns + unsteady_ns(t);
  }

 private:
  double unsteady_ns(TrueTime t) const;
  // White noise and random walk over one step of their grid, as GridWalk asks for it.
  double step(double& frequency_ppb, std::int64_t index, double sign) const;

  double skew_ = 0;
  bool is_steady_ = true;  // skew is all there is
  double step_s_ = 0;
  double walk_sigma_ppb_ = 0;  // of the frequency's change in one step
  double phase_sigma_ns_ = 0;  // of the phase's change that the frequencies do not explain
  std::uint64_t run_seed_ = 0;
  ComponentKey wander_key_{""};
  GridWalk<double> walk_;                        // the state is the walking frequency in ppb
  std::unique_ptr<const FlickerNoise> flicker_;  // large, and rarely there
  double ramp_per_s_ = 0;
  double heating_ = 0;
  double heating_time_constant_s_ = 0;
  TrueTime switched_on_{};
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_CLOCK_OSCILLATOR_H_
