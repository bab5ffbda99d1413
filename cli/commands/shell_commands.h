// `simbench completion SHELL` and `simbench manual [COMMAND]`: texts about the command line itself.
#ifndef SIMBENCH_CLI_COMMANDS_SHELL_COMMANDS_H_
#define SIMBENCH_CLI_COMMANDS_SHELL_COMMANDS_H_

#include "cli/options.h"

namespace simbench::cli {

// Added last: `manual` takes the names of the commands that are there. `app` outlives `action`.
void add_completion_command(CLI::App& app, Action& action);
void add_manual_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_SHELL_COMMANDS_H_
