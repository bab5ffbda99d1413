// simbench node: the long-running program of each host of a real rig (hardware/node/node.h).
#ifndef SIMBENCH_CLI_COMMANDS_NODE_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_NODE_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_node_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_NODE_COMMAND_H_
