// The commands and options of simbench as data, read from the parser (CLI::App), and the texts made
// of them: completion scripts and man pages. A command that is added to the parser is in all of
// them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the parser calls it so
class App;
}

namespace simbench::cli {

// What a value may be. kScenario: a name of one, or a file; kArchive: a folder with results, or
// their file; kPipelines: names of the line's scenario with commas between them; kPointer: one of
// that scenario's parameters.
enum class ValueKind : std::uint8_t {
  kNone,
  kWord,
  kScenario,
  kNumber,
  kFolder,
  kFile,
  kCommand,
  kFigure,
  kArchive,
  kPipelines,
  kPointer
};

struct OptionEntry {
  std::vector<std::string> names;  // "-h", "--help"; an argument's place holder
  std::string value_name;          // "SCENARIO"; empty for a flag
  std::string text;                // on one line
  std::string group;
  ValueKind value = ValueKind::kNone;
  std::vector<std::string> words;  // for kWord
  bool required = false;
  bool repeatable = false;
};

struct CommandEntry {
  std::string name;  // empty for simbench itself
  std::string text;
  std::string group;
  std::string footer;
  std::vector<OptionEntry> options;
  std::vector<OptionEntry> arguments;  // in their order; the last may be repeatable
};

struct CommandTable {
  CommandEntry program;
  std::vector<CommandEntry> commands;
};

// The place holder tells the kind of a value that is no word and no number: it begins with
// SCENARIO, ARCHIVE, DIR, FOLDER, PIPELINE, COMMAND, FIGURE or /POINTER, else it is a file. `app`
// is not changed; CLI11 has no const access to its checks.
CommandTable command_table(CLI::App& app);

// The names of its commands alone.
std::vector<std::string> command_names(CLI::App& app);

// The command that options without one mean: `simbench --scenario S`.
inline constexpr const char* kDefaultCommand = "run";

// A script that completes simbench's command lines in a shell.
//
// Commands, options and fixed words are in the script. It runs simbench (`simbench list scenarios
// --format names`) for the names of scenarios, of the scenario's pipelines and parameters, and of
// figures, so that a new one needs no new script. Other values get files, folders, or nothing
// (numbers). `simbench --scenario S` and `simbench S` are completed as `simbench run --scenario S`.
std::string bash_completion(const CommandTable& table);
std::string zsh_completion(const CommandTable& table);
std::string fish_completion(const CommandTable& table);

// Man pages: troff with the man(7) macros, section 1. First simbench(1), which lists the commands,
// then simbench-NAME(1) of one of table.commands.
//
// A command's footer is divided: paragraphs that begin with "Example" become EXAMPLES, with "Exit
// status:" EXIT STATUS, the others part of the DESCRIPTION.
std::string manual_page(const CommandTable& table);
std::string manual_page(const CommandTable& table, const CommandEntry& command);

}  // namespace simbench::cli
