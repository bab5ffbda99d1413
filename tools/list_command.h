// simbench list: the scenarios, pipelines and algorithms that there are.
#ifndef SIMBENCH_TOOLS_LIST_COMMAND_H_
#define SIMBENCH_TOOLS_LIST_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_list_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_LIST_COMMAND_H_
