// simbench list: the scenarios, pipelines and algorithms that there are.
#ifndef SIMBENCH_CLI_COMMANDS_LIST_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_LIST_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_list_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_LIST_COMMAND_H_
