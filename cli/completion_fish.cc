#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

#include "cli/completion.h"

namespace simbench::cli {
namespace {

constexpr const char* kFishHead =
    R"(# fish completion for simbench; made by `simbench completion fish`.

# The command of the line so far; empty while there is none.
function __simbench_command
    set -l words (commandline -opc)
    set -e words[1]
    if not set -q words[1]
        return
    end
    switch $words[1]
        case '-*'
            echo DEFAULT
        case '*'
            echo $words[1]
    end
end

function __simbench_is
    test (count (__simbench_command)) -gt 0; and test (__simbench_command) = $argv[1]
end

# The options of the default command stand for it.
function __simbench_starts
    test (count (__simbench_command)) -eq 0
end

function __simbench_scenarios
    set -l words (commandline -opc)
    eval (string escape -- $words[1]) list scenarios --format names 2>/dev/null
    __fish_complete_path (commandline -ct)
end

complete -c simbench -f
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string fish_quoted(std::string text) {
  return fmt::format("'{}'", replaced(replaced(std::move(text), "\\", "\\\\"), "'", "\\'"));
}

// The options of `complete` that offer what a value may be.
std::string candidates(const OptionEntry& entry) {
  switch (entry.value) {
    case ValueKind::kNone:
      return "";
    case ValueKind::kWord:
      return " -x -a " + fish_quoted(fmt::format("{}", fmt::join(entry.words, " ")));
    case ValueKind::kScenario:
      return " -x -a '(__simbench_scenarios)'";
    case ValueKind::kNumber:
      return " -x";
    case ValueKind::kFolder:
      return " -x -a '(__fish_complete_directories (commandline -ct))'";
    case ValueKind::kFile:
      break;
  }
  return " -r -F";
}

std::string option_line(const std::string& condition, const OptionEntry& option) {
  std::string names;
  for (const std::string& name : option.names) {
    names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  return fmt::format("complete -c simbench -n '{}'{}{} -d {}\n", condition, names,
                     candidates(option), fish_quoted(option.text));
}

std::string argument_line(const std::string& condition, const OptionEntry& argument) {
  // -x is about the value of an option; a plain file is what -F brings back after -f.
  std::string offered = candidates(argument);
  if (argument.value == ValueKind::kFile) offered = " -F";
  if (argument.value == ValueKind::kNumber) return "";
  if (offered.starts_with(" -x")) offered.erase(0, 3);
  return fmt::format("complete -c simbench -n '{}'{} -d {}\n", condition, offered,
                     fish_quoted(argument.value_name));
}

}  // namespace

std::string fish_completion(const CommandTable& table) {
  std::string text = replaced(kFishHead, "DEFAULT", kDefaultCommand);
  for (const OptionEntry& option : table.program.options) {
    text += option_line("__simbench_starts", option);
  }
  for (const CommandEntry& command : table.commands) {
    text += fmt::format("\ncomplete -c simbench -n __simbench_starts -a {} -d {}\n", command.name,
                        fish_quoted(command.text));
    const std::string is = "__simbench_is " + command.name;
    const std::string condition =
        command.name == kDefaultCommand ? fmt::format("{}; or __simbench_starts", is) : is;
    for (const OptionEntry& option : command.options) {
      // --help is simbench's own there.
      const bool shared = option.names.back() == "--help";
      text += option_line(shared ? is : condition, option);
    }
    for (const OptionEntry& argument : command.arguments) text += argument_line(is, argument);
  }
  return text;
}

}  // namespace simbench::cli
