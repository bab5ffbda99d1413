#include "tools/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace simbench::tools {
namespace {

bool is_override(const std::string& text) {
  return !text.empty() && text.front() == '/' && text.find('=') != std::string::npos;
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
  return CLI::Validator(check, "");
}

CLI::Validator number_within(double low, double high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error == std::errc() && stop == end && low <= value && value <= high) return "";
    return fmt::format("found '{}', allowed: a number from {} to {}", text, low, high);
  };
  return CLI::Validator(check, "");
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto check = [words](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return "";
    return fmt::format("found '{}', allowed: {}", text, fmt::join(words, ", "));
  };
  return CLI::Validator(check, "");
}

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
  command
      .add_option("--format", format,
                  fmt::format("One of: {}. Default: {}", fmt::join(formats, ", "), format))
      ->type_name("FORMAT")
      ->check(one_of(formats));
}

void print_result(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout) {
    throw std::runtime_error(fmt::format("the result could not be written to standard output: {}",
                                         errno ? std::strerror(errno) : "write error"));
  }
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << '\n';
}

}  // namespace simbench::tools
