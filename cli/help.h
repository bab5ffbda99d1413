// The text of --help, and the messages about a command line that cannot be parsed: what was found,
// what is allowed, and where to read more.
#pragma once

#include <cstddef>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): the parser calls it so
class App;
class ParseError;
}  // namespace CLI

namespace simbench::cli {

// What the program is for, in a line.
inline constexpr const char* kProgramSummary =
    "How well will these cameras, on these hosts, be synchronised?";

// The widest help, in columns; it is wrapped to the page where that is narrower.
inline constexpr std::size_t kHelpWidth = 100;

// Sets the layout of the help, also of subcommands that are added later.
void format_help(CLI::App& app);

// Puts the subcommands without a group into `group`, under which the help lists them.
void group_commands(CLI::App& app, const std::string& group);

// What the program prints without arguments: the three commands that a newcomer needs.
std::string start_page();

// The help of a command, or of the program if `command` is empty.
std::string help_text(CLI::App& app, const std::string& command);

// Whether the word is a command.
bool is_command(CLI::App& app, const std::string& word);

// The message about a word that stands where a command should: CLI11 would only report a missing
// one.
std::string unknown_command(CLI::App& app, const std::string& word);

// The message about CLI11's error.
std::string usage_error(CLI::App& app, const CLI::ParseError& error);

}  // namespace simbench::cli
