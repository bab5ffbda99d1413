// simbench validate: checks scenario files without running them.
#ifndef SIMBENCH_CLI_COMMANDS_VALIDATE_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_VALIDATE_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_validate_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_VALIDATE_COMMAND_H_
