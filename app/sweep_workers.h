// The workers of sweeps (evaluation/sweep/task_farm.h) in simulated worlds, which Ctrl-C stops
// (app/interrupt.h).
#ifndef SIMBENCH_APP_SWEEP_WORKERS_H_
#define SIMBENCH_APP_SWEEP_WORKERS_H_

#include "evaluation/sweep/task_farm.h"

namespace simbench::app {

evaluation::TaskWorkerFactory simulated_sweep_workers();

}  // namespace simbench::app

#endif  // SIMBENCH_APP_SWEEP_WORKERS_H_
