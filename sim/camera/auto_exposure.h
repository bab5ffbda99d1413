// The exposure time of a camera over time: constant, or changed in steps by auto-exposure.
//
// Steps come as a Poisson process in true time from the camera's start, and each goes to a value
// that depends on nothing before it, U(min_ms, max_ms). Before the first step the exposure is the
// configured one. All streams of a camera share its exposure, and its steps are drawn from a random
// stream of its own: values are a function of time, whatever the order of the queries.
//
// Source: docs/design.md section 7; the process is an assumption (scenarios/schema.json).
// Complexity: O(log steps so far).
//
//   AutoExposureLoop exposure(scenario.cameras.auto_exposure, from_ms(8.0), seed, 3, camera_start);
//   shutter.set_exposure(exposure.at(engine.now()));
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

class AutoExposureLoop {
 public:
  // `initial`: the exposure when the camera starts, and always if there is no auto-exposure.
  AutoExposureLoop(const scenarios::AutoExposure& settings, Nanoseconds initial,
                   std::uint64_t run_seed, std::size_t camera, TrueTime camera_start);

  // The exposure time in force at `t`.
  Nanoseconds at(TrueTime t) { return settings_.is_on() ? stepped(t) : steps_.front().exposure; }

 private:
  struct Step {
    TrueTime at;
    Nanoseconds exposure;  // from then on
  };

  Nanoseconds stepped(TrueTime t);

  scenarios::AutoExposure settings_;
  RandomStream stream_;
  TrueTime next_step_ = TrueTime::max();
  std::vector<Step> steps_;  // in order of time; the first is the camera's start
};

}  // namespace simbench::sim
