#include "algorithms/parameters.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

// The shortest text that reads back as the same number.
std::string text_of(double number) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return {buffer.data(), end};
}

std::string quoted(const std::string& text) { return '"' + text + '"'; }

std::string text_of(const ParameterValue& value) {
  if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* number = std::get_if<double>(&value)) return text_of(*number);
  return quoted(std::get<std::string>(value));
}

void append_quoted(std::string& list, const std::string& word) {
  list += (list.empty() ? "" : ", ") + quoted(word);
}

std::string allowed(const ParameterSpec& spec) {
  if (std::holds_alternative<bool>(spec.fallback)) return "true or false";
  if (std::holds_alternative<double>(spec.fallback)) {
    return "a number from " + text_of(spec.low) + " to " + text_of(spec.high);
  }
  if (spec.choices.empty()) return "a text";
  std::string choices;
  for (const std::string& choice : spec.choices) append_quoted(choices, choice);
  return "one of " + choices;
}

bool allows(const ParameterSpec& spec, const ParameterValue& value) {
  if (value.index() != spec.fallback.index()) return false;
  if (const double* number = std::get_if<double>(&value)) {
    return *number >= spec.low && *number <= spec.high;  // false for a NaN
  }
  if (const std::string* text = std::get_if<std::string>(&value)) {
    return spec.choices.empty() || std::ranges::count(spec.choices, *text) > 0;
  }
  return true;
}

[[noreturn]] void throw_unknown(const std::vector<ParameterSpec>& specs, const std::string& name) {
  std::string known;
  for (const ParameterSpec& spec : specs) append_quoted(known, spec.name);
  throw ParameterError(
      name, "unknown parameter " + quoted(name) + "; " +
                (known.empty() ? "this algorithm has none" : "known parameters: " + known));
}

// Blames the one of the two that was given, as the other is a default.
void check_order(const ParameterSpec& spec, const ParameterValues& values,
                 const ParameterValues& given) {
  const auto other = values.find(spec.not_below);
  if (other == values.end()) return;
  const double low = std::get<double>(other->second);
  const double high = std::get<double>(values.at(spec.name));
  if (low <= high) return;
  if (given.contains(spec.name)) {
    throw ParameterError(spec.name, "parameter " + quoted(spec.name) + " is " + text_of(high) +
                                        "; allowed: at least " + quoted(spec.not_below) +
                                        ", which is " + text_of(low));
  }
  throw ParameterError(spec.not_below, "parameter " + quoted(spec.not_below) + " is " +
                                           text_of(low) + "; allowed: at most " +
                                           quoted(spec.name) + ", which is " + text_of(high));
}

}  // namespace

Parameters check_parameters(const std::vector<ParameterSpec>& specs, const ParameterValues& given) {
  Parameters checked;
  for (const ParameterSpec& spec : specs) checked.values_[spec.name] = spec.fallback;
  for (const auto& [name, value] : given) {
    const auto spec = std::ranges::find(specs, name, &ParameterSpec::name);
    if (spec == specs.end()) throw_unknown(specs, name);
    if (!allows(*spec, value)) {
      throw ParameterError(name, "parameter " + quoted(name) + " is " + text_of(value) +
                                     "; allowed: " + allowed(*spec));
    }
    checked.values_[name] = value;
  }
  for (const ParameterSpec& spec : specs) check_order(spec, checked.values_, given);
  return checked;
}

const ParameterValue& Parameters::at(const std::string& name) const {
  const auto found = values_.find(name);
  SIMBENCH_ASSERT(found != values_.end(), "the algorithm uses a parameter it did not declare");
  return found->second;
}

double Parameters::number(const std::string& name) const { return std::get<double>(at(name)); }
bool Parameters::flag(const std::string& name) const { return std::get<bool>(at(name)); }
const std::string& Parameters::text(const std::string& name) const {
  return std::get<std::string>(at(name));
}

}  // namespace simbench
