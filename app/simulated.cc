#include "app/simulated.h"

#include "app/interrupt.h"
#include "evaluation/sweep/task_farm.h"
#include "sim/rig/simulation.h"

namespace simbench::app {

std::unique_ptr<RecordingSource> simulated_world(const scenarios::Scenario& scenario) {
  return interruptible(sim::make_simulation(scenario));
}

evaluation::TaskWorkerFactory simulated_sweep_workers() {
  return evaluation::sweep_workers(simulated_world);
}

}  // namespace simbench::app
