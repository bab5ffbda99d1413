#include "cli/help_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "reports/text/plain_text.h"

namespace simbench::cli {
namespace {

constexpr std::size_t kIndent = 2;
constexpr std::size_t kTextColumn = 30;
constexpr std::size_t kNarrowTextColumn = 8;
constexpr const char* kUngrouped = "Subcommands";  // CLI11's default

std::size_t width() { return std::min(kHelpWidth, reports::page_width().value_or(kHelpWidth)); }

// A name, and beside it what it means; below it where the page is narrow or the name long.
std::string entry_text(const std::string& name, const std::string& text) {
  const std::size_t column = width() < 2 * kTextColumn ? kNarrowTextColumn : kTextColumn;
  std::string words = text;
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

// CLI11 makes an empty group of what has none; a footer begins with the line break of its literal.
std::string without_first_break(std::string text) {
  text.erase(0, text.find_first_not_of('\n'));
  return text;
}

}  // namespace

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
  return footer.empty() ? "" : reports::fitted(footer + "\n");
}

void group_commands(CLI::App& app, const std::string& group) {
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    if (command->get_group() == kUngrouped) command->group(group);
  }
}

}  // namespace simbench::cli
