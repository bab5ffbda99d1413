#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/algorithm/string/replace.hpp>
#include <string>
#include <vector>

#include "cli/command_table.h"
#include "cli/completion_scripts.h"
#include "recording/shell_quoted.h"
#include "reports/text/escaped_text.h"

namespace simbench::cli {
namespace {

using boost::replace_all_copy;

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

std::string kind_text(const OptionEntry& entry) {
  return replace_all_copy(std::string(offer(entry.value).bash), "{}", words_of(entry));
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
  return fmt::format("{}() {{\n  case {} in\n{}    *) echo '{}' ;;\n  esac\n}}\n", name, subject,
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
  const std::vector<std::string> cases = {
      function("_simbench_options", "$1", options, ""),
      function("_simbench_value", "\"$1 $2\"", values, "-"),
      function("_simbench_argument", "\"$1 $2\"", arguments, "-")};
  return reports::filled(completion::bash_script(),
                         {{"commands", fmt::format("{}", fmt::join(names, " "))},
                          {"cases", fmt::format("{}", fmt::join(cases, "\n"))},
                          {"default_command", kDefaultCommand}});
}

namespace {

// Escapes text within the brackets of an option's explanation, and between colons.
std::string escaped(std::string text) {
  text = replace_all_copy(text, "\\", "\\\\");
  for (const char* special : {"[", "]", ":"}) {
    text = replace_all_copy(text, special, std::string("\\") + special);
  }
  return text;
}

std::string action(const OptionEntry& entry) {
  return replace_all_copy(std::string(offer(entry.value).zsh), "{}", words_of(entry));
}

std::string option_specs(const OptionEntry& option) {
  std::string text;
  for (const std::string& name : option.names) {
    std::string excluded = fmt::format("({})", fmt::join(option.names, " "));
    if (option.repeatable) excluded = "*";
    const bool value = option.value != ValueKind::kNone;
    const std::string joined = value && name.starts_with("--") ? name + "=" : name;
    text += fmt::format(
        "  {}\n", shell_quoted(fmt::format(
                      "{}{}[{}]{}", excluded, joined, escaped(option.text),
                      value ? fmt::format(":{}:{}", escaped(option.value_name), action(option))
                            : std::string())));
  }
  return text;
}

std::string specs(const std::string& name, const CommandEntry& command) {
  std::string text = fmt::format("_simbench_{}=(\n", replace_all_copy(name, "-", "_"));
  for (const OptionEntry& option : command.options) text += option_specs(option);
  for (const OptionEntry& argument : command.arguments) {
    text += fmt::format("  {}\n",
                        shell_quoted(fmt::format("{}:{}:{}", argument.repeatable ? "*" : "",
                                                 escaped(argument.value_name), action(argument))));
  }
  return text + ")\n";
}

}  // namespace

std::string zsh_completion(const CommandTable& table) {
  std::string tables = "_simbench_commands=(\n";
  for (const CommandEntry& command : table.commands) {
    tables += fmt::format("  {}\n",
                          shell_quoted(fmt::format("{}:{}", command.name, escaped(command.text))));
  }
  tables += ")\n" + specs("program_options", table.program);
  for (const CommandEntry& command : table.commands) tables += specs(command.name, command);
  return reports::filled(completion::zsh_script(),
                         {{"tables", tables}, {"default_command", kDefaultCommand}});
}

namespace {

std::string quoted_for_fish(std::string text) {
  return fmt::format("'{}'", replace_all_copy(replace_all_copy(text, "\\", "\\\\"), "'", "\\'"));
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
  std::string text =
      reports::filled(completion::fish_script(), {{"default_command", kDefaultCommand}}) +
      fish_commands(table);
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
