// simbench keygen: the key that the nodes of a rig share.
#ifndef SIMBENCH_CLI_COMMANDS_KEYGEN_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_KEYGEN_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_keygen_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_KEYGEN_COMMAND_H_
