// simbench fit: from a recording of a rig to parameters of a scenario, and how good the fit is.
#ifndef SIMBENCH_TOOLS_FIT_COMMAND_H_
#define SIMBENCH_TOOLS_FIT_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_fit_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_FIT_COMMAND_H_
