// simbench sweep: the response of every pipeline to parameters of the scenario.
#ifndef SIMBENCH_CLI_COMMANDS_SWEEP_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_SWEEP_COMMAND_H_

#include "cli/options.h"
#include "evaluation/sweep/task_farm.h"

namespace simbench::cli {

// `farm` works on the runs; null: the cores of this machine.
void add_sweep_command(CLI::App& app, Action& action, evaluation::TaskFarm* farm);

// Those who work on the runs of sweeps, in simulated worlds. They end at SIGINT by an exception
// (app/interrupt.h).
evaluation::TaskWorkerFactory simulated_sweep_workers();

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_SWEEP_COMMAND_H_
