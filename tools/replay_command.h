// simbench replay: the scores of a recording folder; device_time and gathering over CSV of real
// cameras.
#ifndef SIMBENCH_TOOLS_REPLAY_COMMAND_H_
#define SIMBENCH_TOOLS_REPLAY_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

// `arguments` is the command as given, for the archive's manifest.
void add_replay_command(CLI::App& app, Action& action, std::vector<std::string> arguments);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_REPLAY_COMMAND_H_
