#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "cli/completion.h"

namespace simbench::cli {
namespace {

constexpr const char* kBashHead =
    R"bash(# bash completion for simbench; made by `simbench completion bash`.

)bash";

// What is asked of the tables: the options of a command; what follows an option of a command; what
// the argument at a place of a command may be. "-" is no value at all, as of a flag.
constexpr const char* kBody = R"bash(
# The candidates of a kind of value for the word being typed.
_simbench_complete() {
  local word=$2
  case $1 in
    word\ *) mapfile -t COMPREPLY < <(compgen -W "${1#word }" -- "$word") ;;
    folder) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$word") ;;
    file) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    scenario)
      compopt -o filenames
      mapfile -t COMPREPLY < <(
        compgen -W "$("$3" list scenarios --format names 2> /dev/null)" -- "$word"
        compgen -f -- "$word"
      )
      ;;
  esac
}

_simbench() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} at=1 command option='' place=0 kind
  local -a words=()
  COMPREPLY=()
  # bash breaks words at "=": --format=json is three of them.
  while (( at < COMP_CWORD )); do
    [[ ${COMP_WORDS[at]} == = ]] || words+=("${COMP_WORDS[at]}")
    (( at += 1 ))
  done
  [[ $word != = ]] || word=
  if (( ${#words[@]} == 0 )); then
    kind="word $_simbench_commands"
    [[ $word != -* ]] || kind="word $(_simbench_options '') $(_simbench_options DEFAULT)"
    _simbench_complete "$kind" "$word"
    return
  fi
  command=${words[0]}
  if [[ $command == -* ]]; then command=DEFAULT; else words=("${words[@]:1}"); fi
  for at in "${words[@]}"; do
    if [[ -n $option ]]; then
      option=
    elif [[ $at == -* ]]; then
      option=$at
      [[ $(_simbench_value "$command" "$option") != - ]] || option=
    else
      (( place += 1 ))
    fi
  done
  if [[ -n $option ]]; then
    kind=$(_simbench_value "$command" "$option")
  elif [[ $word == -* ]]; then
    kind="word $(_simbench_options "$command")"
  else
    kind=$(_simbench_argument "$command" "$place")
  fi
  _simbench_complete "$kind" "$word" "$program"
}

complete -F _simbench simbench
)bash";

std::string kind_text(const OptionEntry& entry) {
  switch (entry.value) {
    case ValueKind::kNone:
      return "-";
    case ValueKind::kWord:
      return fmt::format("word {}", fmt::join(entry.words, " "));
    case ValueKind::kScenario:
      return "scenario";
    case ValueKind::kNumber:
      return "number";
    case ValueKind::kFolder:
      return "folder";
    case ValueKind::kFile:
      break;
  }
  return "file";
}

std::string options_case(const CommandEntry& command) {
  std::vector<std::string> names;
  for (const OptionEntry& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return fmt::format("    '{}') echo '{}' ;;\n", command.name, fmt::join(names, " "));
}

std::string value_cases(const CommandEntry& command) {
  std::string text;
  for (const OptionEntry& option : command.options) {
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) {
      patterns.push_back(fmt::format("'{} {}'", command.name, name));
    }
    text += fmt::format("    {}) echo '{}' ;;\n", fmt::join(patterns, " | "), kind_text(option));
  }
  return text;
}

std::string argument_cases(const CommandEntry& command) {
  std::string text;
  for (std::size_t place = 0; place < command.arguments.size(); ++place) {
    const OptionEntry& argument = command.arguments[place];
    const std::string pattern = argument.repeatable ? fmt::format("'{} '*", command.name)
                                                    : fmt::format("'{} {}'", command.name, place);
    text += fmt::format("    {}) echo '{}' ;;\n", pattern, kind_text(argument));
  }
  return text;
}

std::string function(const char* name, const char* subject, const std::string& cases,
                     const char* otherwise) {
  return fmt::format("{}() {{\n  case {} in\n{}    *) echo '{}' ;;\n  esac\n}}\n\n", name, subject,
                     cases, otherwise);
}

}  // namespace

std::string bash_completion(const CommandTable& table) {
  std::vector<std::string> names;
  std::string options = options_case(table.program);
  std::string values;
  std::string arguments;
  for (const CommandEntry& command : table.commands) {
    names.push_back(command.name);
    options += options_case(command);
    values += value_cases(command);
    arguments += argument_cases(command);
  }
  std::string body = kBody;
  for (std::size_t at = body.find("DEFAULT"); at != std::string::npos; at = body.find("DEFAULT")) {
    body.replace(at, 7, kDefaultCommand);
  }
  return fmt::format("{}_simbench_commands='{}'\n\n{}{}{}{}", kBashHead, fmt::join(names, " "),
                     function("_simbench_options", "$1", options, ""),
                     function("_simbench_value", "\"$1 $2\"", values, "-"),
                     function("_simbench_argument", "\"$1 $2\"", arguments, "-"), body.substr(1));
}

}  // namespace simbench::cli
