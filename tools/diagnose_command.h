// simbench diagnose: is the hardware synchronisation of a recorded rig working at all?
#ifndef SIMBENCH_TOOLS_DIAGNOSE_COMMAND_H_
#define SIMBENCH_TOOLS_DIAGNOSE_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_diagnose_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_DIAGNOSE_COMMAND_H_
