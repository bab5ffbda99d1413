#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "cli/completion.h"

namespace simbench::cli {
namespace {

constexpr const char* kZshHead = R"zsh(#compdef simbench
# zsh completion for simbench; made by `simbench completion zsh`.

_simbench_scenarios() {
  local -a names
  names=(${(f)"$(_call_program scenarios ${(q)_simbench_program} list scenarios --format names 2> /dev/null)"})
  _alternative 'scenarios:scenario:compadd -a names' 'files:scenario file:_files'
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
      _describe -t commands command _simbench_commands
    fi
    return
  fi
  if [[ $words[2] == -* ]]; then
    words=($words[1] DEFAULT "${(@)words[2,-1]}")
    (( CURRENT += 1 ))
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

std::string zsh_replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string zsh_quoted(const std::string& text) {
  return fmt::format("'{}'", zsh_replaced(text, "'", "'\\''"));
}

// Within the brackets of an option's explanation, and between colons.
std::string zsh_escaped(std::string text) {
  text = zsh_replaced(std::move(text), "\\", "\\\\");
  for (const char* special : {"[", "]", ":"}) {
    text = zsh_replaced(std::move(text), special, std::string("\\") + special);
  }
  return text;
}

std::string action(const OptionEntry& entry) {
  switch (entry.value) {
    case ValueKind::kWord:
      return fmt::format("({})", fmt::join(entry.words, " "));
    case ValueKind::kScenario:
      return "_simbench_scenarios";
    case ValueKind::kFolder:
      return "_files -/";
    case ValueKind::kFile:
      return "_files";
    case ValueKind::kNone:
    case ValueKind::kNumber:
      break;
  }
  return " ";
}

std::string option_specs(const OptionEntry& option) {
  std::string text;
  for (const std::string& name : option.names) {
    std::string excluded = fmt::format("({})", fmt::join(option.names, " "));
    if (option.repeatable) excluded = "*";
    const bool value = option.value != ValueKind::kNone;
    const std::string joined = value && name.starts_with("--") ? name + "=" : name;
    text += fmt::format(
        "  {}\n", zsh_quoted(fmt::format(
                      "{}{}[{}]{}", excluded, joined, zsh_escaped(option.text),
                      value ? fmt::format(":{}:{}", zsh_escaped(option.value_name), action(option))
                            : std::string())));
  }
  return text;
}

std::string specs(const std::string& name, const CommandEntry& command) {
  std::string text = fmt::format("_simbench_{}=(\n", zsh_replaced(name, "-", "_"));
  for (const OptionEntry& option : command.options) text += option_specs(option);
  for (const OptionEntry& argument : command.arguments) {
    text += fmt::format(
        "  {}\n", zsh_quoted(fmt::format("{}:{}:{}", argument.repeatable ? "*" : "",
                                         zsh_escaped(argument.value_name), action(argument))));
  }
  return text + ")\n";
}

}  // namespace

std::string zsh_completion(const CommandTable& table) {
  std::string text = fmt::format("{}_simbench_commands=(\n", kZshHead);
  for (const CommandEntry& command : table.commands) {
    text += fmt::format("  {}\n",
                        zsh_quoted(fmt::format("{}:{}", command.name, zsh_escaped(command.text))));
  }
  text += ")\n" + specs("program_options", table.program);
  for (const CommandEntry& command : table.commands) text += specs(command.name, command);
  return text + zsh_replaced(kZshTail, "DEFAULT", kDefaultCommand);
}

}  // namespace simbench::cli
