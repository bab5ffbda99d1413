// `simbench validate-model`: the real-network experiment beside its simulation.
#ifndef SIMBENCH_TOOLS_VALIDATE_MODEL_COMMAND_H_
#define SIMBENCH_TOOLS_VALIDATE_MODEL_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_validate_model_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_VALIDATE_MODEL_COMMAND_H_
