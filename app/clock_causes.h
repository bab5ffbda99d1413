// What limits the best row of a run of the hosts' clocks, in simulated worlds.
//
//   const evaluation::ClockCauses causes = causes_of({}, scenario, {}, nullptr);
#pragma once

#include "evaluation/clock_run/clock_evaluation.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// evaluation/clock_run/clock_causes.h says which causes. Throws what evaluate_clocks() throws.
evaluation::ClockCauses causes_of(const evaluation::ClockResults& results,
                                  const scenarios::Scenario& scenario,
                                  const evaluation::ClockOptions& options,
                                  const evaluation::Progress& progress);

}  // namespace simbench::app
