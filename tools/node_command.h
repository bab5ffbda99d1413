// simbench node: the long-running program of each host of a real rig (hardware/node/node.h).
#ifndef SIMBENCH_TOOLS_NODE_COMMAND_H_
#define SIMBENCH_TOOLS_NODE_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_node_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_NODE_COMMAND_H_
