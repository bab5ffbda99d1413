// simbench run: every pipeline of a scenario over many seeds, then the table.
#ifndef SIMBENCH_TOOLS_RUN_COMMAND_H_
#define SIMBENCH_TOOLS_RUN_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

// `arguments` is the command as given, for the archive's manifest.
void add_run_command(CLI::App& app, Action& action, std::vector<std::string> arguments);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_RUN_COMMAND_H_
