// What limits a host synchronisation, by counterfactual runs: of each cause that this world has,
// the same clocks with the same seeds without it.
//
// Problem: a user sees clocks apart and wants to know why.
//
// Naive attempt: name the shape of the error: constant errors come from unequal paths, moving ones
// from noise and drift.
//
// Why it fails: a clock that was stepped once moves by 140 s, and no noise did that.
//
// Key idea: take away what happened. The causes are steps of a clock and leap seconds, hosts and
// links that stopped, the temperature of the hosts, traffic, busy processors, unequal paths, queues
// and bursts, the wander and skew of the oscillators, noise of the stamps, and time between the
// algorithm's questions (asked twice as often). A cause is listed if without it the mean spread of
// the clocks, or the largest error of a host, is smaller by kLeastEffect. Causes overlap: their
// effects do not add up.
//
// Programs are not asked, nor are worlds in which two runs of the row take more than
// kMostClockReadings readings of hosts. Cost: at most ten runs of a row over kCauseSeeds seeds.
// Errors: those of evaluate_clocks().
//
//   const ClockCauses causes =
//       clock_causes(scenario, "chrony", make_clocks, {.duration_s = 3600}, nullptr);
//   for (const ClockCause& cause : causes.found) print(cause.what, cause.spread_to_ms);
#pragma once

#include <string>
#include <vector>

#include "evaluation/clock_run/clock_evaluation.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {

inline constexpr std::uint64_t kCauseSeeds = 2;
inline constexpr double kLeastEffect = 0.2;
inline constexpr double kMostClockReadings = 2e6;

ClockCauses clock_causes(const scenarios::Scenario& scenario, const std::string& pipeline,
                         const ClockWorldFactory& make_world, const ClockOptions& options,
                         const Progress& progress);

}  // namespace simbench::evaluation
