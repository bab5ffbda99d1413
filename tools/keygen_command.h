// simbench keygen: the key that the nodes of a rig share.
#ifndef SIMBENCH_TOOLS_KEYGEN_COMMAND_H_
#define SIMBENCH_TOOLS_KEYGEN_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_keygen_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_KEYGEN_COMMAND_H_
