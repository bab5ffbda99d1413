// An algorithm's parameters, each stated once beside the member of its settings that holds it.
//
// Settings name their parameters in a member function bind(): name with its unit, member, range,
// meaning, source. The member's initialiser is the default. From this one statement come the specs
// that scenarios are checked by and `simbench describe` prints (specs_of), and the settings that an
// algorithm is made with (settings_from). Registered forms of one algorithm differ in the defaults:
// each is a value of the settings.
//
//   struct FitSettings {
//     std::size_t points = 16;
//     Nanoseconds window = from_ms(250);
//     void bind(ParameterBinder& parameters) {
//       parameters.number("points", points, 1, 100, "of the fit", "assumption");
//       parameters.number("window_ms", window, 1, 1e4, "span of the points", "assumption");
//     }
//   };
//
//   std::vector<ParameterSpec> specs = specs_of(FitSettings{.points = 8});
//   FitSettings settings = settings_from<FitSettings>(check_parameters(specs, {}));
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "algorithms/parameters.h"
#include "algorithms/ports/time.h"

namespace simbench {

// Visits the members of some settings: lists their parameters, or reads them. A default that its
// parameter would read as another value is a programming error.
class ParameterBinder {
 public:
  // Lists: each member's value is its parameter's default, and stays.
  ParameterBinder() = default;
  // Reads: each member gets its parameter's value. `values` must outlive this.
  explicit ParameterBinder(const Parameters& values) : values_(&values) {}

  // A number from `low` to `high`, both included; whole-number members drop the fraction. The name
  // of a span of time ends with its unit: _us, _ms, _s or _hours.
  template <class Number>
  ParameterBinder& number(const std::string& name, Number& member, double low, double high,
                          const std::string& meaning, const std::string& source) {
    if constexpr (std::is_same_v<Number, Nanoseconds>) {
      return time_span(name, member, low, high, meaning, source);
    } else {
      auto value = static_cast<double>(member);
      exchange(value, name, low, high, meaning, source);
      member = static_cast<Number>(value);
      return *this;
    }
  }
  // A number in another unit than the member's: the member is `factor` times the number.
  ParameterBinder& scaled(const std::string& name, double& member, double factor, double low,
                          double high, const std::string& meaning, const std::string& source);
  // The logarithm to base 2 of the member's seconds.
  ParameterBinder& log2_seconds(const std::string& name, Nanoseconds& member, double low,
                                double high, const std::string& meaning, const std::string& source);
  // Yes or no.
  ParameterBinder& flag(const std::string& name, bool& member, const std::string& meaning,
                        const std::string& source);
  // One of some words, each of which stands for a value of the member.
  template <class Value>
  ParameterBinder& choice(
      const std::string& name, Value& member,
      std::type_identity_t<std::initializer_list<std::pair<const char*, Value>>> words,
      const std::string& meaning, const std::string& source) {
    std::vector<std::string> choices;
    for (const auto& [word, value] : words) choices.emplace_back(word);
    const auto* const held =
        std::ranges::find(words, member, &std::pair<const char*, Value>::second);
    const std::string chosen = word_of(
        name, std::move(choices), static_cast<std::size_t>(held - words.begin()), meaning, source);
    member = std::ranges::find(words, chosen, &std::pair<const char*, Value>::first)->second;
    return *this;
  }
  // The number named last must not be below that other one, which is named too.
  ParameterBinder& not_below(const std::string& other);

  // What was listed, in order.
  std::vector<ParameterSpec> take() { return std::move(specs_); }

 private:
  ParameterBinder& time_span(const std::string& name, Nanoseconds& member, double low, double high,
                             const std::string& meaning, const std::string& source);
  void exchange(double& value, const std::string& name, double low, double high,
                const std::string& meaning, const std::string& source);
  std::string word_of(const std::string& name, std::vector<std::string> choices, std::size_t held,
                      const std::string& meaning, const std::string& source);

  const Parameters* values_ = nullptr;  // null: lists
  std::vector<ParameterSpec> specs_;
};

// The parameters of some settings, whose present values are the defaults.
template <class Settings>
std::vector<ParameterSpec> specs_of(Settings defaults) {
  ParameterBinder binder;
  defaults.bind(binder);
  return binder.take();
}

// The settings that checked parameters state; what is no parameter is as in `defaults`.
template <class Settings>
Settings settings_from(const Parameters& parameters, Settings defaults = {}) {
  ParameterBinder binder(parameters);
  defaults.bind(binder);
  return defaults;
}

}  // namespace simbench
