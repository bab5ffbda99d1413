// simbench convert-ibl: recordings of the IBL camera rigs as CSV for simbench replay.
#ifndef SIMBENCH_CLI_COMMANDS_CONVERT_IBL_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_CONVERT_IBL_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_convert_ibl_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_CONVERT_IBL_COMMAND_H_
