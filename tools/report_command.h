// `simbench report DIR [DIR...] -o report.html`: result archives as one HTML file.
//
// What an archive does not hold (stamps, clocks, error budgets) is run again: a run is a function
// of scenario, pipeline and seed. That, and the size of the file, are why only some seeds are shown
// in detail; the tables and the distributions are of all of them.
#ifndef SIMBENCH_TOOLS_REPORT_COMMAND_H_
#define SIMBENCH_TOOLS_REPORT_COMMAND_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/options.h"

namespace simbench::tools {

// `arguments` is the whole command line; the report shows it.
void add_report_command(CLI::App& app, Action& action, std::vector<std::string> arguments);

}  // namespace simbench::tools

#endif  // SIMBENCH_TOOLS_REPORT_COMMAND_H_
