// simbench gate: a result held to a baseline, for CI.
#ifndef SIMBENCH_TOOLS_GATE_COMMAND_H_
#define SIMBENCH_TOOLS_GATE_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_gate_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_GATE_COMMAND_H_
