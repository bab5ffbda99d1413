// What every algorithm would give on a rig: the model that was fitted to a recording, under all
// pipelines of the leaderboard that it can run.
//
// The boards of host synchronisation are left out for a rig with one host: there is nothing to
// synchronise. An algorithm that needs what the model lacks (hardware stamps, pulses, polls of the
// cameras' clocks) is left out and named.
//
//   const FittedRanking ranking = ranking_of(scenario);
//   evaluate(ranking.scenario, [&] { return simulated_world(ranking.scenario); }, {}, progress);
#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace simbench::app {

struct FittedRanking {
  scenarios::Scenario scenario;         // prints a leaderboard
  std::vector<std::string> left_out{};  // "host.pps: needs a pulse per second (...)"
};

FittedRanking ranking_of(const scenarios::Scenario& fitted);

}  // namespace simbench::app
