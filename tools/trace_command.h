// simbench trace: one run of one pipeline as a timeline, for the Perfetto UI or PlotJuggler.
#ifndef SIMBENCH_TOOLS_TRACE_COMMAND_H_
#define SIMBENCH_TOOLS_TRACE_COMMAND_H_

#include "tools/options.h"

namespace simbench::tools {

void add_trace_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_TRACE_COMMAND_H_
