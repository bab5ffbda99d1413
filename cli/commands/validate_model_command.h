// `simbench validate-model`: the real-network experiment beside its simulation.
#ifndef SIMBENCH_CLI_COMMANDS_VALIDATE_MODEL_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_VALIDATE_MODEL_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_validate_model_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_VALIDATE_MODEL_COMMAND_H_
