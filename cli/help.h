// The text of --help, and the messages about a command line that cannot be parsed: what was found,
// what is allowed, and where to read more.
#ifndef SIMBENCH_CLI_HELP_H_
#define SIMBENCH_CLI_HELP_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the parser calls it so
class App;
class ParseError;
}  // namespace CLI

namespace simbench::cli {

// The widest help, in columns; it is wrapped to the page where that is narrower.
inline constexpr std::size_t kHelpWidth = 100;

// Sets the layout of the help, also of subcommands that are added later.
void format_help(CLI::App& app);

// Puts the subcommands without a group into `group`, under which the help lists them.
void group_commands(CLI::App& app, const std::string& group);

// The message if the first word of the command line is no command: CLI11 would only report a
// missing one. `arguments` with the program's name.
std::optional<std::string> unknown_command(CLI::App& app,
                                           const std::vector<std::string>& arguments);

// The message about CLI11's error.
std::string usage_error(CLI::App& app, const CLI::ParseError& error);

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_HELP_H_
