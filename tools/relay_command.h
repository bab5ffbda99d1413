// `simbench relay`: the network of a scenario between nodes on one machine (hardware/relay).
#ifndef SIMBENCH_TOOLS_RELAY_COMMAND_H_
#define SIMBENCH_TOOLS_RELAY_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_relay_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_RELAY_COMMAND_H_
