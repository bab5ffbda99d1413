#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

#include "cli/command_table.h"
#include "hardware/shell_quoted.h"

namespace simbench::cli {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// A script with the name of the default command in place of DEFAULT.
std::string named_default_command(const char* script) {
  return replaced(script, "DEFAULT", kDefaultCommand);
}

// What each shell offers for a kind of value. In bash's and zsh's "{}" stands for the words; fish
// gets words by an option of their own.
struct Offer {
  const char* bash;
  const char* zsh;
  const char* fish;
};

const Offer& offer(ValueKind kind) {
  static constexpr Offer kOffers[] = {
      {"-", " ", ""},
      {"word {}", "({})", " -x -a "},
      {"scenario", "_simbench_scenarios", " -x -a '(__simbench_scenarios)'"},
      {"number", " ", " -x"},
      {"folder", "_files -/", " -x -a '(__fish_complete_directories (commandline -ct))'"},
      {"file", "_files", " -r -F"},
      {"command", "_simbench_command_names", " -x -a '(__simbench_commands)'"},
      {"figure", "_simbench_figures", " -x -a '(__simbench_names figures)'"},
      {"archive", "_simbench_archives", " -x -a '(__simbench_archives)'"},
      {"pipelines", "_simbench_pipelines", " -x -a '(__simbench_pipelines)'"},
      {"pointer", "_simbench_pointers", " -x -a '(__simbench_pointers)'"}};
  return kOffers[static_cast<std::size_t>(kind)];
}

std::string words_of(const OptionEntry& entry) {
  return fmt::format("{}", fmt::join(entry.words, " "));
}

constexpr const char* kBashHead =
    R"bash(# bash completion for simbench; made by `simbench completion bash`.

)bash";

// Uses three functions that are made from the table: the options of a command, the values of an
// option of a command, the values of an argument. "-" is no value, as for a flag.
constexpr const char* kBashBody = R"bash(
# Those of the folders that hold results, or hold a folder that does; all if none does.
_simbench_archives() {
  local folder
  local -a all=() found=()
  while IFS= read -r folder; do
    all+=("$folder")
    if [[ -e $folder/results.json ]] || compgen -G "$folder/*/results.json" > /dev/null; then
      found+=("$folder")
    fi
  done
  (( ${#found[@]} )) || found=("${all[@]}")
  (( ${#found[@]} == 0 )) || printf '%s\n' "${found[@]}"
}

# The candidates of a kind of value for the word being typed: KIND WORD PROGRAM SCENARIO.
_simbench_complete() {
  local word=$2 before=
  case $1 in
    word\ *) mapfile -t COMPREPLY < <(compgen -W "${1#word }" -- "$word") ;;
    folder) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$word") ;;
    file) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    command) mapfile -t COMPREPLY < <(compgen -W "$_simbench_commands" -- "$word") ;;
    figure)
      mapfile -t COMPREPLY < <(
        compgen -W "$("$3" list figures --format names 2> /dev/null)" -- "$word")
      ;;
    archive)
      compopt -o filenames
      mapfile -t COMPREPLY < <(
        compgen -d -- "$word" | _simbench_archives
        compgen -f -X '!*.json' -- "$word"
      )
      ;;
    pipelines)
      [[ -n $4 ]] || return
      [[ $word != *,* ]] || before=${word%,*},
      mapfile -t COMPREPLY < <(
        compgen -P "$before" -W \
          "$("$3" list pipelines --scenario "$4" --format names 2> /dev/null)" -- "${word##*,}")
      ;;
    pointer)
      [[ -n $4 ]] || return
      compopt -o nospace
      mapfile -t COMPREPLY < <(
        compgen -S = -W "$("$3" describe "$4" --format names 2> /dev/null)" -- "$word")
      ;;
    start)
      mapfile -t COMPREPLY < <(compgen -W "$_simbench_commands" -- "$word")
      [[ -z $word || ${#COMPREPLY[@]} -gt 0 ]] || _simbench_complete scenario "$word" "$3"
      ;;
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
  local scenario=
  local -a words=()
  COMPREPLY=()
  # bash breaks words at "=": --format=json is three of them.
  while (( at < COMP_CWORD )); do
    [[ ${COMP_WORDS[at]} == = ]] || words+=("${COMP_WORDS[at]}")
    (( at += 1 ))
  done
  [[ $word != = ]] || word=
  if (( ${#words[@]} == 0 )); then
    kind=start
    [[ $word != -* ]] || kind="word $(_simbench_options '') $(_simbench_options DEFAULT)"
    _simbench_complete "$kind" "$word" "$program"
    return
  fi
  command=${words[0]}
  if [[ $command == -* ]]; then
    command=DEFAULT
  else
    words=("${words[@]:1}")
    if [[ " $_simbench_commands " != *" $command "* ]]; then
      scenario=$command command=DEFAULT
    fi
  fi
  for at in "${words[@]}"; do
    if [[ -n $option ]]; then
      [[ $option != --scenario ]] || scenario=$at
      option=
    elif [[ $at == -* ]]; then
      option=$at
      [[ $(_simbench_value "$command" "$option") != - ]] || option=
    else
      [[ $command != describe || $place != 0 ]] || scenario=$at
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
  _simbench_complete "$kind" "$word" "$program" "$scenario"
}

complete -F _simbench simbench
)bash";

std::string kind_text(const OptionEntry& entry) {
  return replaced(offer(entry.value).bash, "{}", words_of(entry));
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
  return fmt::format("{}_simbench_commands='{}'\n\n{}{}{}{}", kBashHead, fmt::join(names, " "),
                     function("_simbench_options", "$1", options, ""),
                     function("_simbench_value", "\"$1 $2\"", values, "-"),
                     function("_simbench_argument", "\"$1 $2\"", arguments, "-"),
                     named_default_command(kBashBody).substr(1));
}

namespace {

constexpr const char* kZshHead = R"zsh(#compdef simbench
# zsh completion for simbench; made by `simbench completion zsh`.

_simbench_scenarios() {
  local -a names
  names=(${(f)"$(_call_program scenarios ${(q)_simbench_program} list scenarios --format names 2> /dev/null)"})
  _alternative 'scenarios:scenario:compadd -a names' 'files:scenario file:_files'
}

_simbench_command_names() {
  _describe -t commands command _simbench_commands
}

_simbench_figures() {
  local -a names
  names=(${(f)"$(_call_program figures ${(q)_simbench_program} list figures --format names 2> /dev/null)"})
  compadd -a names
}

# Folders with results.json, or with a folder that has one.
_simbench_archives() {
  _alternative 'archives:archive:_files -/' 'files:results.json:_files -g "*.json"'
}

# The line's scenario: after --scenario, or what `describe` describes.
_simbench_scenario() {
  local -i at=${words[(I)--scenario]}
  local word
  REPLY=
  [[ ${words[1]} != describe ]] || REPLY=${words[2]}
  (( ! at )) || REPLY=${words[at+1]}
  for word in $words; do
    [[ $word != --scenario=* ]] || REPLY=${word#--scenario=}
  done
  [[ -n $REPLY ]]
}

_simbench_pipelines() {
  local REPLY
  _simbench_scenario || return 1
  local -a names
  names=(${(f)"$(_call_program pipelines ${(q)_simbench_program} list pipelines --scenario ${(q)REPLY} --format names 2> /dev/null)"})
  compset -P '*,'
  compadd -S '' -a names
}

_simbench_pointers() {
  local REPLY
  _simbench_scenario || return 1
  local -a names
  names=(${(f)"$(_call_program parameters ${(q)_simbench_program} describe ${(q)REPLY} --format names 2> /dev/null)"})
  compadd -S = -a names
}

)zsh";

constexpr const char* kZshTail = R"zsh(
# Options without a command are those of the default command.
_simbench() {
  local _simbench_program=$words[1] curcontext=$curcontext
  if (( CURRENT == 2 )); then
    if [[ $PREFIX == -* ]]; then
      _arguments -S $_simbench_program_options $_simbench_DEFAULT
    else
      _describe -t commands command _simbench_commands || _simbench_scenarios
    fi
    return
  fi
  if [[ $words[2] == -* ]]; then
    words=($words[1] DEFAULT "${(@)words[2,-1]}")
    (( CURRENT += 1 ))
  elif [[ -z ${(M)_simbench_commands:#${words[2]}:*} ]]; then
    words=($words[1] DEFAULT --scenario "${(@)words[2,-1]}")
    (( CURRENT += 2 ))
  fi
  local specs=_simbench_${words[2]//-/_}
  (( ${(P)+specs} )) || return 1
  shift words
  (( CURRENT -= 1 ))
  _arguments -S "${(@P)specs}"
}

if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
  _simbench "$@"
else
  compdef _simbench simbench
fi
)zsh";

// Escapes text within the brackets of an option's explanation, and between colons.
std::string escaped(std::string text) {
  text = replaced(std::move(text), "\\", "\\\\");
  for (const char* special : {"[", "]", ":"}) {
    text = replaced(std::move(text), special, std::string("\\") + special);
  }
  return text;
}

std::string action(const OptionEntry& entry) {
  return replaced(offer(entry.value).zsh, "{}", words_of(entry));
}

std::string option_specs(const OptionEntry& option) {
  std::string text;
  for (const std::string& name : option.names) {
    std::string excluded = fmt::format("({})", fmt::join(option.names, " "));
    if (option.repeatable) excluded = "*";
    const bool value = option.value != ValueKind::kNone;
    const std::string joined = value && name.starts_with("--") ? name + "=" : name;
    text += fmt::format(
        "  {}\n", hardware::shell_quoted(fmt::format(
                      "{}{}[{}]{}", excluded, joined, escaped(option.text),
                      value ? fmt::format(":{}:{}", escaped(option.value_name), action(option))
                            : std::string())));
  }
  return text;
}

std::string specs(const std::string& name, const CommandEntry& command) {
  std::string text = fmt::format("_simbench_{}=(\n", replaced(name, "-", "_"));
  for (const OptionEntry& option : command.options) text += option_specs(option);
  for (const OptionEntry& argument : command.arguments) {
    text += fmt::format("  {}\n", hardware::shell_quoted(
                                      fmt::format("{}:{}:{}", argument.repeatable ? "*" : "",
                                                  escaped(argument.value_name), action(argument))));
  }
  return text + ")\n";
}

}  // namespace

std::string zsh_completion(const CommandTable& table) {
  std::string text = fmt::format("{}_simbench_commands=(\n", kZshHead);
  for (const CommandEntry& command : table.commands) {
    text += fmt::format("  {}\n", hardware::shell_quoted(
                                      fmt::format("{}:{}", command.name, escaped(command.text))));
  }
  text += ")\n" + specs("program_options", table.program);
  for (const CommandEntry& command : table.commands) text += specs(command.name, command);
  return text + named_default_command(kZshTail);
}

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
    if contains -- $words[1] (__simbench_commands)
        echo $words[1]
    else
        echo DEFAULT
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

function __simbench_names
    set -l words (commandline -opc)
    eval (string escape -- $words[1]) list $argv --format names 2>/dev/null
end

# Folders, and files of results.
function __simbench_archives
    __fish_complete_directories (commandline -ct)
    __fish_complete_suffix .json
end

# The line's scenario: after --scenario, a word in place of the command, or what describe describes.
function __simbench_scenario
    set -l words (commandline -opc)
    set -e words[1]
    if set -l at (contains -i -- --scenario $words)
        echo $words[(math $at + 1)]
    else if test "$words[1]" = describe
        echo $words[2]
    else if not contains -- $words[1] (__simbench_commands)
        echo $words[1]
    end
end

function __simbench_pipelines
    set -l scenario (__simbench_scenario)
    test -n "$scenario"; or return
    set -l before (commandline -ct | string replace -r '[^,]*$' '')
    for name in (__simbench_names pipelines --scenario (string escape -- $scenario))
        echo $before$name
    end
end

function __simbench_pointers
    set -l words (commandline -opc)
    set -l scenario (__simbench_scenario)
    test -n "$scenario"; or return
    eval (string escape -- $words[1] describe $scenario) --format names 2>/dev/null | string replace -r '$' =
end

complete -c simbench -f
)";

std::string quoted_for_fish(std::string text) {
  return fmt::format("'{}'", replaced(replaced(std::move(text), "\\", "\\\\"), "'", "\\'"));
}

// The options of `complete` that offer the values.
std::string candidates(const OptionEntry& entry) {
  const std::string offered = offer(entry.value).fish;
  return entry.value == ValueKind::kWord ? offered + quoted_for_fish(words_of(entry)) : offered;
}

std::string option_line(const std::string& condition, const OptionEntry& option) {
  std::string names;
  for (const std::string& name : option.names) {
    names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  return fmt::format("complete -c simbench -n '{}'{}{} -d {}\n", condition, names,
                     candidates(option), quoted_for_fish(option.text));
}

std::string argument_line(const std::string& condition, const OptionEntry& argument) {
  // -x and -r concern the value of an option; -F offers files in spite of the general -f.
  std::string offered = candidates(argument);
  if (argument.value == ValueKind::kFile) offered = " -F";
  if (argument.value == ValueKind::kNumber) return "";
  if (offered.starts_with(" -x")) offered.erase(0, 3);
  return fmt::format("complete -c simbench -n '{}'{} -d {}\n", condition, offered,
                     quoted_for_fish(argument.value_name));
}

std::string fish_commands(const CommandTable& table) {
  std::string text = "function __simbench_commands\n    printf '%s\\n'";
  for (const CommandEntry& command : table.commands) text += " " + command.name;
  return text + "\nend\n\n";
}

}  // namespace

std::string fish_completion(const CommandTable& table) {
  std::string text = named_default_command(kFishHead) + fish_commands(table);
  text +=
      "complete -c simbench -n '__simbench_starts; and test -n (commandline -ct)' "
      "-a '(__simbench_scenarios)' -d SCENARIO\n";
  for (const OptionEntry& option : table.program.options) {
    text += option_line("__simbench_starts", option);
  }
  for (const CommandEntry& command : table.commands) {
    text += fmt::format("\ncomplete -c simbench -n __simbench_starts -a {} -d {}\n", command.name,
                        quoted_for_fish(command.text));
    const std::string is = "__simbench_is " + command.name;
    const std::string condition =
        command.name == kDefaultCommand ? fmt::format("{}; or __simbench_starts", is) : is;
    for (const OptionEntry& option : command.options) {
      // Without a command --help is simbench's own.
      const bool shared = option.names.back() == "--help";
      text += option_line(shared ? is : condition, option);
    }
    for (const OptionEntry& argument : command.arguments) text += argument_line(is, argument);
  }
  return text;
}

}  // namespace simbench::cli
