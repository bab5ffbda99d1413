// Parameters of an algorithm: what it declares, and the checked values it is made with.
//
// An algorithm states each parameter once - name, default, range, meaning, source -, most simply
// beside the member that holds it (parameter_binder.h). A scenario may set it; check_parameters()
// refuses names that were not declared, values out of range and values that contradict each other,
// so a factory can rely on what it gets.
//
//   const std::vector<ParameterSpec> specs = {{.name = "stamps", .fallback = 100,
//       .low = 1, .high = 1e6, .choices = {}, .meaning = "n_d", .source = "assumption"}};
//   Parameters parameters = check_parameters(specs, {{"stamps", 10.0}});
//   parameters.number("stamps");   // 10
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace simbench {

using ParameterValue = std::variant<bool, double, std::string>;
using ParameterValues = std::map<std::string, ParameterValue>;

// The value of a parameter that no scenario sets: true, 16, 0.5 or "text".
class ParameterDefault : public ParameterValue {
 public:
  ParameterDefault() = default;
  template <class Value>
  requires(!std::is_base_of_v<ParameterValue, std::remove_cvref_t<Value>>)
      ParameterDefault(Value&& value)  // NOLINT(google-explicit-constructor): `.fallback = 16`
      : ParameterValue(held(std::forward<Value>(value))) {}

 private:
  template <class Value>
  static auto held(Value&& value) {
    using Plain = std::remove_cvref_t<Value>;
    if constexpr (std::is_same_v<Plain, bool>) {
      return value;
    } else if constexpr (std::is_arithmetic_v<Plain>) {
      return static_cast<double>(value);
    } else {
      return std::string(std::forward<Value>(value));
    }
  }
};

struct ParameterSpec {
  std::string name;           // with its unit, e.g. "threshold_ms"
  ParameterDefault fallback;  // the value if a scenario sets none; also fixes the type
  double low = 0;             // allowed range of a number
  double high = 0;
  std::vector<std::string> choices;  // allowed texts
  std::string meaning;
  std::string source;
  std::string not_below{};  // another parameter of the algorithm, whose number this one must reach
};

// A value that is not allowed. `parameter` names it, for a JSON pointer.
class ParameterError : public std::invalid_argument {
 public:
  ParameterError(std::string parameter, const std::string& what)
      : std::invalid_argument(what), parameter_(std::move(parameter)) {}
  const std::string& parameter() const { return parameter_; }

 private:
  std::string parameter_;
};

// Checked values; a query for a name that was not declared is a programming error.
class Parameters {
 public:
  Parameters() = default;
  double number(const std::string& name) const;
  bool flag(const std::string& name) const;
  const std::string& text(const std::string& name) const;
  const ParameterValues& all() const { return values_; }

 private:
  friend Parameters check_parameters(const std::vector<ParameterSpec>&, const ParameterValues&);
  const ParameterValue& at(const std::string& name) const;
  ParameterValues values_;
};

// The declared parameters with `given` over their defaults. Throws ParameterError with what was
// found and what is allowed.
Parameters check_parameters(const std::vector<ParameterSpec>& specs, const ParameterValues& given);

// The source of a value that nobody documents.
inline constexpr const char* kAssumption = "assumption";

}  // namespace simbench
