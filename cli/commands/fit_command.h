// simbench fit: from a recording of a rig to parameters of a scenario, and how good the fit is.
#ifndef SIMBENCH_CLI_COMMANDS_FIT_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_FIT_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_fit_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_FIT_COMMAND_H_
