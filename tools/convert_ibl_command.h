// simbench convert-ibl: recordings of the IBL camera rigs as CSV for simbench replay.
#ifndef SIMBENCH_TOOLS_CONVERT_IBL_COMMAND_H_
#define SIMBENCH_TOOLS_CONVERT_IBL_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_convert_ibl_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_CONVERT_IBL_COMMAND_H_
