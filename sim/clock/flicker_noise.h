// Flicker noise of an oscillator's frequency: power ~ 1/f, so that the Allan deviation is the same
// at all averaging times, the "floor" of the oscillator.
//
// It is a sum of ten independent Ornstein-Uhlenbeck processes of equal variance with time constants
// of 10 ms * 4^k, up to 2621 s. With this spacing the Allan deviation of the sum is the standard
// deviation of one of them times sqrt(log(4) / (2 log 2)) = 1, flat within 5 % from 0.1 s to
// 1000 s (it is 3 % low at 0.1 s, 4 % at 1000 s, below 1.5 % off between 0.3 s and 300 s; the test
// has the closed form).
//
// Sampled exactly on a grid of 100 ms or finer: each process by its own transition, and of the
// phase, given all of them at both ends of a step, the conditional mean and variance. Both hold in
// either direction of time. Each step has random numbers of its own, keyed by its index.
//
// Units: nanoseconds, ppb. Complexity: GridWalk's, some 120 ns for each new step.
// Sources: Riley, "Handbook of Frequency Stability Analysis", NIST SP 1065 (flicker floor);
// the sum: Barnes and Jarvis, NBS TN 604 (1971); the rest is elementary.
//
//   const FlickerNoise flicker(0.5, 100.0, seed, "host3/oscillator");
//   double ahead_ns = flicker.phase_ns(t.time_since_epoch().count());
#ifndef SIMBENCH_SIM_CLOCK_FLICKER_NOISE_H_
#define SIMBENCH_SIM_CLOCK_FLICKER_NOISE_H_

#include <array>
#include <cstdint>
#include <string_view>

#include "sim/clock/grid_walk.h"
#include "sim/engine/random.h"

namespace simbench::sim {

class FlickerNoise {
 public:
  // `floor_ppb`: the Allan deviation. The grid is `step_ms`, or 100 ms if that is finer.
  FlickerNoise(double floor_ppb, double step_ms, std::uint64_t run_seed,
               std::string_view component);

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
  std::uint64_t run_seed_;
  ComponentKey key_;
  GridWalk<Frequencies> walk_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_CLOCK_FLICKER_NOISE_H_
