#include "cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <utility>

namespace simbench::cli {
namespace {

bool is_override(const std::string& text) {
  return !text.empty() && text.front() == '/' && text.find('=') != std::string::npos;
}

// The names of the checks, which CLI11 shows nowhere. The words of one_of() follow its name, a line
// each.
constexpr const char* kNumberCheck = "number";
constexpr const char* kWordsCheck = "one of";

// The name of the option's first check; empty if it has none.
std::string check_name(CLI::Option& option) {
  try {
    return option.get_validator(0)->get_name();
  } catch (const CLI::OptionNotFound&) {
    return "";
  }
}

void add_json_flag(CLI::App& command, const std::string& text, std::function<void()> action) {
  command.add_flag_callback("--json", std::move(action), text)->disable_flag_override();
}

}  // namespace

CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stop == end && low <= value && value <= high) return "";
    return fmt::format("found '{}', allowed: a whole number from {} to {}", text, low, high);
  };
  return {check, "", kNumberCheck};
}

CLI::Validator number_within(double low, double high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stop == end && low <= value && value <= high) return "";
    return fmt::format("found '{}', allowed: a number from {} to {}", text, low, high);
  };
  return {check, "", kNumberCheck};
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto check = [words](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return "";
    return fmt::format("found '{}', allowed: {}", text, fmt::join(words, ", "));
  };
  return {check, "", fmt::format("{}\n{}", kWordsCheck, fmt::join(words, "\n"))};
}

std::vector<std::string> allowed_words(CLI::Option& option) {
  std::vector<std::string> words = CLI::detail::split(check_name(option), '\n');
  if (words.empty() || words.front() != kWordsCheck) return {};
  words.erase(words.begin());
  return words;
}

bool takes_number(CLI::Option& option) { return check_name(option) == kNumberCheck; }

void add_set_option(CLI::App& command, std::vector<std::string>& values) {
  const auto check = [](const std::string& text) -> std::string {
    if (is_override(text)) return "";
    return fmt::format("found '{}', allowed: /json/pointer=value, as in /timeline/frames=100",
                       text);
  };
  command
      .add_option("--set", values,
                  "Change a parameter of the scenario, repeatable;\n"
                  "`simbench describe SCENARIO` names them all")
      ->type_name("/POINTER=VALUE")
      ->allow_extra_args(false)
      ->check(CLI::Validator(check, ""));
}

std::vector<scenarios::Override> overrides_of(const std::vector<std::string>& values) {
  std::vector<scenarios::Override> overrides;
  for (const std::string& text : values) {
    const std::size_t equals = text.find('=');
    overrides.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return overrides;
}

void add_format_option(CLI::App& command, std::string& format,
                       const std::vector<std::string>& formats) {
  format = formats.front();
  const CLI::Option* option =
      command
          .add_option("--format", format,
                      fmt::format("One of: {}. Default: {}", fmt::join(formats, ", "), format))
          ->type_name("FORMAT")
          ->check(one_of(formats));
  if (std::find(formats.begin(), formats.end(), "json") == formats.end()) return;
  // Options are carried out in this order, so --format has been.
  add_json_flag(command,
                "For scripts: --format json, and progress, warnings and errors on\n"
                "standard error as JSON lines",
                [option, &format] {
                  if (option->count() > 0 && format != "json") {
                    throw CLI::ValidationError(
                        "--json", fmt::format("found with --format {}, allowed: --format json, or "
                                              "no --format at all",
                                              format));
                  }
                  format = "json";
                });
}

void add_json_messages_option(CLI::App& command) {
  add_json_flag(command,
                "For scripts: progress, warnings and errors on standard error as\nJSON lines",
                [] {});
}

void print_result(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout) {
    throw std::runtime_error(fmt::format("the result could not be written to standard output: {}",
                                         errno ? std::strerror(errno) : "write error"));
  }
}

}  // namespace simbench::cli
