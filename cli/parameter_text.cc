#include "cli/parameter_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <variant>

namespace simbench::cli {

std::string default_text(const ParameterSpec& spec) {
  const ParameterValue& value = spec.fallback;
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return std::get<std::string>(value);
}

std::string range_text(const ParameterSpec& spec) {
  const ParameterValue& value = spec.fallback;
  if (std::holds_alternative<bool>(value)) return "true, false";
  if (std::holds_alternative<std::string>(value)) {
    return fmt::format("{}", fmt::join(spec.choices, ", "));
  }
  const std::string range = fmt::format("{} to {}", spec.low, spec.high);
  return spec.not_below.empty() ? range : fmt::format("{}, not below {}", range, spec.not_below);
}

}  // namespace simbench::cli
