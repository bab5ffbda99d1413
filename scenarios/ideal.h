// A scenario with some of its stages ideal: worlds in which a part of the error has no cause.
//
// scenarios/schema.json says of each member to which stage of an error budget it belongs (x-stage,
// its own or that of what it is in; "none" if to none) and what it is where that stage is ideal
// (x-ideal; null: left out), or why it stays as it is (x-stays). Budgets say what their stages are:
// evaluation/budget/budget.h, evaluation/budget/host_clock_budget.h.
//
//   const Scenario exact = with_ideal_stages(scenario, {"trigger", "exposure"});
#pragma once

#include <string_view>
#include <vector>

#include "scenarios/scenario.h"

namespace simbench::scenarios {

// Stages that no member names change nothing.
Scenario with_ideal_stages(const Scenario& scenario, const std::vector<std::string_view>& stages);

}  // namespace simbench::scenarios
