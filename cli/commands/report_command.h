// `simbench report DIR [DIR...] -o report.html`: result archives as one HTML file.
//
// What an archive does not hold (stamps, clocks, error budgets) is run again: a run is a function
// of scenario, pipeline and seed. That, and the size of the file, are why only some seeds are shown
// in detail; the tables and the distributions are of all of them.
#ifndef SIMBENCH_CLI_COMMANDS_REPORT_COMMAND_H_
#define SIMBENCH_CLI_COMMANDS_REPORT_COMMAND_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/options.h"

namespace simbench::cli {

// `arguments` is the whole command line; the report shows it.
void add_report_command(CLI::App& app, Action& action, std::vector<std::string> arguments);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMANDS_REPORT_COMMAND_H_
