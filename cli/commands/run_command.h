// simbench run: every pipeline of a scenario over many seeds, then the table.
#ifndef SIMBENCH_CLI_COMMANDS_RUN_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_RUN_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

// `arguments` is the command as given, for the archive's manifest.
void add_run_command(CLI::App& app, Action& action, std::vector<std::string> arguments);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_RUN_COMMAND_H_
