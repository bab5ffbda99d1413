// `simbench figure NAME`: one figure as a file for a paper (SVG, PDF) or as data (CSV).
#ifndef SIMBENCH_TOOLS_FIGURE_COMMAND_H_
#define SIMBENCH_TOOLS_FIGURE_COMMAND_H_

#include <CLI/CLI.hpp>

#include "tools/options.h"

namespace simbench::tools {

void add_figure_command(CLI::App& app, Action& action);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_FIGURE_COMMAND_H_
