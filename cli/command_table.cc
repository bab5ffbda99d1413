#include "cli/command_table.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "cli/command.h"

namespace simbench::cli {
namespace {

// Joins the lines of a text, whose breaks are for the help.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

ValueKind value_kind(CLI::Option& option, const OptionEntry& entry) {
  if (option.get_items_expected_max() == 0) return ValueKind::kNone;
  if (!entry.words.empty()) return ValueKind::kWord;
  if (takes_number(option)) return ValueKind::kNumber;
  static constexpr std::pair<const char*, ValueKind> kKinds[] = {
      {"SCENARIO", ValueKind::kScenario},  {"DIR", ValueKind::kFolder},
      {"FOLDER", ValueKind::kFolder},      {"ARCHIVE", ValueKind::kArchive},
      {"PIPELINE", ValueKind::kPipelines}, {"COMMAND", ValueKind::kCommand},
      {"FIGURE", ValueKind::kFigure},      {"/POINTER", ValueKind::kPointer}};
  for (const auto& [beginning, kind] : kKinds) {
    if (entry.value_name.starts_with(beginning)) return kind;
  }
  return ValueKind::kFile;
}

OptionEntry entry_of(CLI::Option& option) {
  OptionEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  const bool takes_value = option.get_items_expected_max() > 0;
  if (takes_value) entry.value_name = option.get_type_name();
  if (entry.names.empty()) entry.names.push_back(entry.value_name);
  entry.text = one_line(option.get_description());
  entry.group = option.get_group();
  entry.words = allowed_words(option);
  entry.value = value_kind(option, entry);
  entry.required = option.get_required();
  entry.repeatable = takes_value && option.get_items_expected_max() > 1;
  return entry;
}

CommandEntry entry_of(CLI::App& command) {
  CommandEntry entry = {.name = command.get_name(),
                        .text = one_line(command.get_description()),
                        .group = command.get_group(),
                        .footer = command.get_footer(),
                        .options = {},
                        .arguments = {}};
  for (CLI::Option* option : command.get_options({})) {
    (option->get_positional() ? entry.arguments : entry.options).push_back(entry_of(*option));
  }
  return entry;
}

// Also those that are not used.
std::vector<CLI::App*> all_commands(CLI::App& app) {
  return app.get_subcommands([](CLI::App*) { return true; });
}

}  // namespace

CommandTable command_table(CLI::App& app) {
  CommandTable table;
  table.program = entry_of(app);
  table.program.name.clear();
  for (CLI::App* command : all_commands(app)) {
    table.commands.push_back(entry_of(*command));
  }
  return table;
}

std::vector<std::string> command_names(CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : all_commands(app)) names.push_back(command->get_name());
  return names;
}

}  // namespace simbench::cli
