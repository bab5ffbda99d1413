// simbench replay: the scores of a recording folder; device_time and gathering over CSV of real
// cameras.
#ifndef SIMBENCH_CLI_COMMANDS_REPLAY_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_REPLAY_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

// `arguments` is the command as given, for the archive's manifest.
void add_replay_command(CLI::App& app, Action& action, std::vector<std::string> arguments);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_REPLAY_COMMAND_H_
