// `simbench figure NAME`: one figure as a file for a paper (SVG, PDF) or as data (CSV).
#ifndef SIMBENCH_CLI_COMMANDS_FIGURE_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_FIGURE_COMMAND_H_

#include <CLI/CLI.hpp>

#include "cli/options.h"

namespace simbench::cli {

void add_figure_command(CLI::App& app, Action& action);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_FIGURE_COMMAND_H_
