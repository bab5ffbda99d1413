// simbench compare: two archives, or pipelines of one, seed by seed.
#ifndef SIMBENCH_TOOLS_COMPARE_COMMAND_H_
#define SIMBENCH_TOOLS_COMPARE_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_compare_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_COMPARE_COMMAND_H_
