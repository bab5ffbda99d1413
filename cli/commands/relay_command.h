// `simbench relay`: the network of a scenario between nodes on one machine (hardware/relay).
#ifndef SIMBENCH_CLI_COMMANDS_RELAY_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_RELAY_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_relay_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_RELAY_COMMAND_H_
