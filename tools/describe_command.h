// simbench describe: every parameter of a scenario, with unit, meaning and source.
#ifndef SIMBENCH_TOOLS_DESCRIBE_COMMAND_H_
#define SIMBENCH_TOOLS_DESCRIBE_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_describe_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_DESCRIBE_COMMAND_H_
