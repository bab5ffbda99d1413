// The temperature at a host's oscillator, as far as it moves about its mean: a day, a load and a
// fan.
//
//   day   a sine
//   load  a square wave (busy for half of the period, idle for the other half) behind a first-order
//         lag, in its periodic steady state
//   fan   a triangle
//
// Each part has the mean 0, the amplitude and the period of the scenario, and a start phase drawn
// uniformly for each host. A part whose amplitude is 0 changes nothing of the others.
//
// The integral over time is a closed form, so that the phase of an oscillator with a temperature
// coefficient is exact: the time within a period is reduced in whole nanoseconds, and what is lost
// to rounding is below 1 ns over days for coefficients of a crystal.
//
// Units: kelvin, kelvin seconds. Complexity: O(1), no state.
// Source: of the lag's steady state, docs/design.md section 7; scenario /hosts/temperature.
//
//   const TemperatureCourse course(*scenario.hosts.temperature, seed, "host3: temperature");
//   const double warmer_k = course.kelvin(engine.now());
//   const double phase_ns = coefficient_ppb_per_k * course.integral_ks(engine.now());
#pragma once

#include <cstdint>
#include <string_view>

#include "recording/true_time.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

// Where a periodic part is: the period and the phase at true zero, both in whole nanoseconds.
class Cycle {
 public:
  // `phase` in [0, 1): the share of the period that has passed at true zero.
  Cycle(double period_s, double phase);

  double period_s() const { return static_cast<double>(period_ns_) * 1e-9; }
  // Since the last begin of the period.
  double seconds_at(TrueTime t) const;

 private:
  std::int64_t period_ns_;
  std::int64_t phase_ns_;
};

class TemperatureCourse {
 public:
  TemperatureCourse(const scenarios::Temperature& parameters, std::uint64_t run_seed,
                    std::string_view component);

  // Above the mean.
  double kelvin(TrueTime t) const;
  // The integral of kelvin() from true zero to `t`, which may lie before it.
  double integral_ks(TrueTime t) const { return since_begin_ks(t) - at_zero_ks_; }

 private:
  // The integrals of the parts since the last begin of their periods; over a period each is 0.
  double since_begin_ks(TrueTime t) const;

  double day_k_;
  double load_k_;
  double fan_k_;
  double lag_s_;
  Cycle day_;
  Cycle load_;
  Cycle fan_;
  double at_zero_ks_;
};

}  // namespace simbench::sim
