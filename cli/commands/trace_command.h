// simbench trace: one run of one pipeline as a timeline, for the Perfetto UI or PlotJuggler.
#ifndef SIMBENCH_CLI_COMMANDS_TRACE_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_TRACE_COMMAND_H_

#include "cli/options.h"

namespace simbench::cli {

void add_trace_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_TRACE_COMMAND_H_
