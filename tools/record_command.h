// simbench record: captures as a recording folder, to be replayed.
#ifndef SIMBENCH_TOOLS_RECORD_COMMAND_H_
#define SIMBENCH_TOOLS_RECORD_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_record_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_RECORD_COMMAND_H_
