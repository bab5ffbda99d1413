#include "app/sweep_workers.h"

#include "app/interrupt.h"

namespace simbench::app {

evaluation::TaskWorkerFactory simulated_sweep_workers() {
  return evaluation::sweep_workers(simulated_world, simulated_clocks);
}

}  // namespace simbench::app
