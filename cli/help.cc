#include "cli/help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string_view>

#include "cli/command_table.h"
#include "reports/text/plain_text.h"
#include "reports/text/program_name.h"
#include "scenarios/loader.h"

namespace simbench::cli {
namespace {

constexpr std::size_t kIndent = 2;
constexpr std::size_t kTextColumn = 30;
constexpr std::size_t kNarrowTextColumn = 8;
constexpr const char* kUngrouped = "Subcommands";  // CLI11's default

// Words that are no commands but that people try, with what they will mean.
struct OtherWord {
  std::string_view word;
  const char* meant;
};
constexpr const char* kPictures =
    "`simbench figure` draws one figure, `simbench report` makes a page of all";
constexpr OtherWord kOtherWords[] = {
    {"plot", kPictures},
    {"draw", kPictures},
    {"simulate", "`simbench run` simulates every pipeline of a scenario"},
    {"diff", "`simbench compare` compares two results seed by seed"},
    {"test", "`simbench gate` compares a result with a baseline"}};

std::size_t width() { return std::min(kHelpWidth, reports::page_width().value_or(kHelpWidth)); }

// A name with its meaning beside it, or below it on a narrow page or after a long name.
std::string entry_text(const std::string& name, const std::string& text) {
  const std::size_t column = width() < 2 * kTextColumn ? kNarrowTextColumn : kTextColumn;
  std::string words = reports::in_this_program(text);
  std::replace(words.begin(), words.end(), '\n', ' ');
  std::string out = std::string(kIndent, ' ') + name;
  bool beside = out.size() + kIndent <= column;
  for (const std::string& line : reports::words_in_lines(words, width() - column)) {
    if (beside) {
      out.resize(column, ' ');
    } else {
      out.append("\n").append(column, ' ');
    }
    out += line;
    beside = false;
  }
  return out + "\n";
}

// A footer begins with the line break of its literal.
std::string without_first_break(std::string text) {
  text.erase(0, text.find_first_not_of('\n'));
  return text;
}

// CLI11's layout with texts wrapped to the page.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App* app) const override;
};

std::string HelpFormat::make_usage(const CLI::App* app, std::string name) const {
  std::string usage = "Usage: " + name;
  if (app->get_parent() == nullptr) {
    usage += " COMMAND [OPTION...]";
  } else {
    for (const CLI::Option* option : app->get_options({})) {
      if (option->get_positional() || !option->get_required()) continue;
      usage += fmt::format(" {} {}", option->get_name(), option->get_type_name());
    }
    usage += " [OPTION...]";
    for (const CLI::Option* option : app->get_options({})) {
      if (!option->get_positional()) continue;
      const std::string place = option->get_type_name();
      usage += option->get_required() ? fmt::format(" {}", place) : fmt::format(" [{}]", place);
    }
  }
  return "\n" + reports::fitted(usage + "\n");
}

std::string HelpFormat::make_group(std::string group, bool is_positional,
                                   std::vector<const CLI::Option*> options) const {
  std::string out = fmt::format("\n{}:\n", group == "Positionals" ? "Arguments" : group);
  for (const CLI::Option* option : options) out += make_option(option, is_positional);
  return out;
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  const std::string place =
      option->get_items_expected_max() > 0 ? option->get_type_name() : std::string();
  const std::string needed = option->get_required() && !is_positional ? "Required. " : "";
  const std::string text = needed + option->get_description();
  if (is_positional) return entry_text(place, text);
  return entry_text(
      fmt::format("{}{}{}", option->get_name(false, true), place.empty() ? "" : " ", place), text);
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  return entry_text(command->get_name(), command->get_description());
}

std::string HelpFormat::make_description(const CLI::App* app) const {
  std::string out;
  for (const std::string& line : reports::words_in_lines(app->get_description(), width())) {
    out += line + "\n";
  }
  return out;
}

std::string HelpFormat::make_footer(const CLI::App* app) const {
  const std::string footer = without_first_break(app->get_footer());
  return footer.empty() ? "" : reports::fitted(reports::in_this_program(footer) + "\n");
}

std::string suggestion(const std::string& found, const std::vector<std::string>& known) {
  const std::vector<std::string> similar = scenarios::nearest(found, known);
  return similar.empty() ? "" : fmt::format(" did you mean {}?", fmt::join(similar, " or "));
}

std::vector<std::string> option_names(const std::vector<OptionEntry>& options) {
  std::vector<std::string> names;
  names.reserve(options.size());
  for (const OptionEntry& option : options) names.push_back(option.names.back());
  return names;
}

// The entry of the parsed command, else of simbench.
CommandEntry used_command(CLI::App& app) {
  const CommandTable table = command_table(app);
  const std::vector<CLI::App*> used = app.get_subcommands();
  for (const CommandEntry& command : table.commands) {
    if (!used.empty() && command.name == used.front()->get_name()) return command;
  }
  return table.program;
}

std::string called(const CommandEntry& command) {
  return command.name.empty() ? reports::program_name()
                              : fmt::format("{} {}", reports::program_name(), command.name);
}

std::string unexpected(const CommandEntry& command, const std::string& found) {
  if (!found.starts_with("-")) {
    return fmt::format(
        "found '{}', but `{}` takes {}", found, called(command),
        command.arguments.empty()
            ? "options only"
            : fmt::format("no more than {}", fmt::join(option_names(command.arguments), " ")));
  }
  // "--seed=3" is the option "--seed".
  const std::string name = found.substr(0, found.find('='));
  const std::vector<std::string> known = option_names(command.options);
  const std::string similar = suggestion(name, known);
  return fmt::format("found '{}', which `{}` does not know;{} allowed: {}", name, called(command),
                     similar, fmt::join(known, ", "));
}

// Explains a missing scenario; `text` is CLI11's "--scenario is required".
std::string missing(const CommandEntry& command, const std::string& text) {
  for (const std::vector<OptionEntry>* entries : {&command.options, &command.arguments}) {
    for (const OptionEntry& entry : *entries) {
      if (!entry.required || entry.value != ValueKind::kScenario) continue;
      return text + ": a scenario's name (see `simbench list`) or file";
    }
  }
  return text;
}

}  // namespace

void format_help(CLI::App& app) { app.formatter(std::make_shared<HelpFormat>()); }

void group_commands(CLI::App& app, const std::string& group) {
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    if (command->get_group() == kUngrouped) command->group(group);
  }
}

std::string start_page() {
  return reports::in_this_program(reports::fitted(fmt::format(
      "{}\n\n{}{}{}\nAll commands: `simbench help`\n", kProgramSummary,
      entry_text("simbench 18cam_6host_45fps", "run a scenario: a table of all its pipelines"),
      entry_text("simbench list", "scenarios and algorithms"),
      entry_text("simbench help run", "what a run can do, by example"))));
}

std::string help_text(CLI::App& app, const std::string& command) {
  if (!command.empty()) return app.get_subcommand(command)->help(app.get_name());
  return app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal);
}

bool is_command(CLI::App& app, const std::string& word) {
  const std::vector<std::string> known = command_names(app);
  return std::find(known.begin(), known.end(), word) != known.end();
}

std::string unknown_command(CLI::App& app, const std::string& word) {
  const std::vector<std::string> commands = command_names(app);
  const std::string allowed = fmt::format("allowed: {}, or a scenario", fmt::join(commands, ", "));
  const auto* other = std::ranges::find(kOtherWords, word, &OtherWord::word);
  if (other != std::end(kOtherWords)) {
    return fmt::format("found '{}': {}; {}", word, other->meant, allowed);
  }
  std::vector<std::string> known = commands;
  for (const scenarios::BuiltinScenario& each : scenarios::builtin_scenarios()) {
    known.push_back(each.name);
  }
  return fmt::format("found '{}',{} {}", word, suggestion(word, known), allowed);
}

std::string usage_error(CLI::App& app, const CLI::ParseError& error) {
  const CommandEntry command = used_command(app);
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    const std::vector<std::string> extras = app.remaining(true);
    if (!extras.empty()) return unexpected(command, extras.front());
  }
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError)) {
    return missing(command, error.what());
  }
  return error.what();
}

}  // namespace simbench::cli
