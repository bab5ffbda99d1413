// simbench validate: checks scenario files without running them.
#ifndef SIMBENCH_TOOLS_VALIDATE_COMMAND_H_
#define SIMBENCH_TOOLS_VALIDATE_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_validate_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_VALIDATE_COMMAND_H_
