// simbench compare: two archives, or pipelines of one, seed by seed.
#ifndef SIMBENCH_CLI_COMMANDS_COMPARE_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_COMPARE_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_compare_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_COMPARE_COMMAND_H_
