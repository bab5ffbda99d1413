// The commands and options of simbench as data, read off the parser (CLI::App): what completion
// scripts, man pages and "did you mean" are made of. A command that is added to the parser is in
// all of them.
#ifndef SIMBENCH_CLI_COMMAND_TABLE_H_
#define SIMBENCH_CLI_COMMAND_TABLE_H_

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the parser calls it so
class App;
}

namespace simbench::cli {

// What a value may be; kScenario: a name of one, or a file.
enum class ValueKind : std::uint8_t { kNone, kWord, kScenario, kNumber, kFolder, kFile };

struct OptionEntry {
  std::vector<std::string> names;  // "-h", "--help"; of an argument its place holder
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

// A value that is no word and no number is told by its place holder: SCENARIO..., DIR... (or
// FOLDER...), else a file. `app` is not changed; CLI11 has no other way to its checks.
CommandTable command_table(CLI::App& app);

// The command that options without one mean: `simbench --scenario S`.
inline constexpr const char* kDefaultCommand = "run";

}  // namespace simbench::cli

#endif  // SIMBENCH_CLI_COMMAND_TABLE_H_
