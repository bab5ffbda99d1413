// The workers of sweeps (evaluation/sweep/task_farm.h) in simulated worlds, which Ctrl-C stops
// (app/interrupt.h).
#pragma once

#include "evaluation/sweep/task_farm.h"

namespace simbench::app {

evaluation::TaskWorkerFactory simulated_sweep_workers();

}  // namespace simbench::app
