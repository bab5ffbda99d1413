// The oscillator of a host or of a camera: how far its count is ahead of true time.
//
// An oscillator counts true time with a frequency error
//
//   y(t) = skew + white noise + flicker + random walk + ramp + self-heating + temperature
//
// A clock built on it needs the phase, the integral of y:
//
//   local(t) = t + deviation_ns(t),   deviation_ns(0) = 0
//
// White frequency noise of Allan deviation W at tau = 1 s makes the phase a random walk of variance
// W^2 tau; a random walk of the frequency of K per sqrt(s) has the Allan deviation K sqrt(tau / 3).
// Both are sampled exactly (their joint law) on a fixed grid of true time of wander_step_ms, and
// the phase is linear in between: the Allan deviation is the configured one from that step on.
// Flicker has a grid of its own. Each step of a grid has random numbers of its own, keyed by its
// index, and the walks start at true zero in both directions: values depend neither on the order of
// the queries nor on when the world starts.
//
// The walk and the ramp end at a frequency error of 5 % (scenarios/frequency_limit.h); whether one
// got there can be asked.
//
// The ramp R begins at true zero: R t^2 / 2. Self-heating of H with time constant T begins when the
// device is switched on, s seconds before t: y = H (1 - exp(-s / T)). The temperature's part is its
// coefficient times the kelvin above the mean (sim/clock/temperature.h).
//
// Units: nanoseconds; skew as a fraction. The phase is exact to well below 1 ns over days: a rate
// of 1e-9 survives. Complexity: O(1) without noise; otherwise a look-up, after each step of the
// grid between true zero and the query has once been sampled (some 20 ns each, some 120 ns with
// flicker; memory: grid_walk.h). Copies share what was sampled, for one thread.
// Source: docs/design.md sections 5 to 7; Riley, "Handbook of Frequency Stability Analysis", NIST
// SP 1065.
//
//   const OscillatorModel oscillator(scenario.hosts.clock.oscillator, seed, "host3/oscillator");
//   double ahead_ns = oscillator.deviation_ns(engine.now());
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/clock/grid_walk.h"
#include "sim/clock/temperature.h"
#include "sim/engine/random.h"

namespace simbench::sim {

// Flicker noise of the frequency: power ~ 1/f, so that the Allan deviation is the same at all
// averaging times, the "floor" of the oscillator.
//
// It is a sum of ten independent Ornstein-Uhlenbeck processes of equal variance with time constants
// of 10 ms * 4^k, up to 2621 s. With this spacing the Allan deviation of the sum is the standard
// deviation of one of them times sqrt(log(4) / (2 log 2)) = 1, flat within 5 % from 0.1 s to
// 1000 s (it is 3 % low at 0.1 s, 4 % at 1000 s, below 1.5 % off between 0.3 s and 300 s; the test
// has the closed form).
//
// Sampled exactly on a grid of 100 ms or finer: each process by its own transition, and the phase
// by its conditional mean and variance, given all of them at both ends of a step. Both hold in
// either direction of time. Source of the sum: Barnes and Jarvis, NBS TN 604 (1971).
class FlickerNoise {
 public:
  // `floor_ppb`: the Allan deviation. The grid is `step_ms`, or 100 ms if that is finer.
  FlickerNoise(double floor_ppb, double step_ms, std::uint64_t run_seed, std::string_view component,
               std::size_t kept_blocks);

  // Local minus true time elapsed since true zero, as far as this noise makes it.
  double phase_ns(std::int64_t since_zero_ns) const;

 private:
  static constexpr std::size_t kProcesses = 10;
  using Frequencies = std::array<double, kProcesses>;  // ppb

  // How one process goes over a step of the grid.
  struct Transition {
    double kept = 0;       // share of the old frequency in the new one
    double sigma_ppb = 0;  // of what is new in it
    double weight_s = 0;   // of the frequencies at both ends in the mean phase
  };

  double step(Frequencies& frequencies, std::int64_t index, double sign) const;

  std::array<Transition, kProcesses> transitions_{};
  double phase_sigma_ns_ = 0;  // of the phase's change that the frequencies do not explain
  KeyedStreams steps_;
  GridWalk<Frequencies> walk_;
};

class OscillatorModel {
 public:
  // Draws the skew and the noise of the component with this name. `kept_blocks`: grid_walk.h.
  OscillatorModel(const scenarios::Oscillator& parameters, std::uint64_t run_seed,
                  std::string_view component, TrueTime switched_on = TrueTime{},
                  std::size_t kept_blocks = GridWalk<double>::kFewestBlocks);
  // An oscillator of this frequency error and no noise.
  explicit OscillatorModel(double skew) : skew_(skew) {}

  // Whether the constant part is all there is: it costs a multiplication then.
  bool is_steady() const { return is_steady_; }
  // The constant part of the frequency error, as a fraction (1e-6 = 1 ppm).
  double skew() const { return skew_; }

  // A measured skew in place of the drawn one.
  void set_skew(double skew) { skew_ = skew; }
  // From now on the frequency follows that temperature.
  void set_temperature(const TemperatureCourse& course, double coefficient_ppb_per_k);

  // The mean frequency error between two instants, as a fraction: all of it, and the temperature's
  // part.
  double mean_frequency(TrueTime from, TrueTime to) const;
  double mean_frequency_by_temperature(TrueTime from, TrueTime to) const;

  // Local minus true time elapsed since true zero.
  double deviation_ns(TrueTime t) const {
    const double linear_ns = skew_ * static_cast<double>(t.time_since_epoch().count());
    return is_steady_ ? linear_ns : linear_ns + unsteady_ns(t);
  }

  // Whether the walk or the ramp ended before `end`, as far as queries have sampled it.
  bool reached_limit(TrueTime end) const;

 private:
  double unsteady_ns(TrueTime t) const;
  double ramp_end_s() const;
  double ramp_ns(double since_zero_s) const;
  double temperature_ns(TrueTime t) const;
  // White noise and random walk over one step of their grid, for GridWalk.
  double step(double& frequency_ppb, std::int64_t index, double sign) const;

  // What each query needs, together in the cache, up to the beginning of the walk.
  double skew_ = 0;
  bool is_steady_ = true;                        // skew is all there is
  std::shared_ptr<const FlickerNoise> flicker_;  // large, and rarely there
  std::shared_ptr<const TemperatureCourse> temperature_;
  double ramp_per_s_ = 0;
  double heating_ = 0;
  GridWalk<double> walk_;  // the state is the walking frequency in ppb

  double step_s_ = 0;
  double walk_sigma_ppb_ = 0;  // of the frequency's change in one step
  double phase_sigma_ns_ = 0;  // of the phase's change that the frequencies do not explain
  KeyedStreams wander_{0, ComponentKey("")};
  // The first step of the grid at which the walk was cut; a cache, as the walk is.
  std::shared_ptr<std::int64_t> first_cut_;
  double heating_time_constant_s_ = 0;
  TrueTime switched_on_{};
  double coefficient_ppb_per_k_ = 0;
};

}  // namespace simbench::sim
