// simbench diagnose: is the hardware synchronisation of a recorded rig working at all?
#ifndef SIMBENCH_CLI_COMMANDS_DIAGNOSE_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_DIAGNOSE_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_diagnose_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_DIAGNOSE_COMMAND_H_
