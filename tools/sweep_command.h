// simbench sweep: the response of every pipeline to parameters of the scenario.
#ifndef SIMBENCH_TOOLS_SWEEP_COMMAND_H_
#define SIMBENCH_TOOLS_SWEEP_COMMAND_H_

#include "evaluation/task_farm.h"
#include "tools/options.h"

namespace simbench::tools {

// `farm` works on the runs; null: the cores of this machine.
void add_sweep_command(CLI::App& app, Action& action, evaluation::TaskFarm* farm);

// Those who work on the runs of sweeps, in simulated worlds. They end at SIGINT by an exception
// (tools/interrupt.h).
evaluation::TaskWorkerFactory simulated_sweep_workers();

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_SWEEP_COMMAND_H_
