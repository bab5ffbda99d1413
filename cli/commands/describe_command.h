// simbench describe: every parameter of a scenario, with unit, meaning and source.
#ifndef SIMBENCH_CLI_COMMANDS_DESCRIBE_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_DESCRIBE_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_describe_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_DESCRIBE_COMMAND_H_
