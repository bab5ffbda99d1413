// simbench gate: a result held to a baseline, for CI.
#ifndef SIMBENCH_CLI_COMMANDS_GATE_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_GATE_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_gate_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_GATE_COMMAND_H_
