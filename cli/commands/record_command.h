// simbench record: captures as a recording folder, to be replayed.
#ifndef SIMBENCH_CLI_COMMANDS_RECORD_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_RECORD_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_record_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_RECORD_COMMAND_H_
