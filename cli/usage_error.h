// What to say about a command line that cannot be parsed: what was found, what is allowed, and
// where to read more.
#ifndef SIMBENCH_CLI_USAGE_ERROR_H_
#define SIMBENCH_CLI_USAGE_ERROR_H_

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace simbench::cli {

// About the first word of the command line, if it is no command: CLI11 would only say that one is
// missing. `arguments` with the program's name.
std::optional<std::string> unknown_command(CLI::App& app,
                                           const std::vector<std::string>& arguments);

// About what CLI11 refused.
std::string usage_error(CLI::App& app, const CLI::ParseError& error);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_USAGE_ERROR_H_
