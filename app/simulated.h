// The simulator as what the command line runs: its captures end at the first Ctrl-C
// (app/interrupt.h).
//
//   evaluate(scenario, [&] { return simulated_world(scenario); }, options, progress);
#ifndef SIMBENCH_APP_SIMULATED_H_
#define SIMBENCH_APP_SIMULATED_H_

#include <memory>

#include "evaluation/sweep/task_farm.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::app {

// `scenario` outlives it. An evaluation::WorldFactory.
std::unique_ptr<RecordingSource> simulated_world(const scenarios::Scenario& scenario);

// Those who work on the runs of sweeps, in simulated worlds.
evaluation::TaskWorkerFactory simulated_sweep_workers();

}  // namespace simbench::app

#endif  // SIMBENCH_APP_SIMULATED_H_
