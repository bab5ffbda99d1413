#include "algorithms/parameter_specs.h"

#include <utility>

namespace simbench {

ParameterSpec number_parameter(std::string name, double fallback, double low, double high,
                               std::string meaning, std::string source) {
  ParameterSpec spec;
  spec.name = std::move(name);
  spec.fallback = fallback;
  spec.low = low;
  spec.high = high;
  spec.meaning = std::move(meaning);
  spec.source = std::move(source);
  return spec;
}

ParameterSpec choice_parameter(std::string name, std::vector<std::string> choices,
                               std::string meaning, std::string source) {
  ParameterSpec spec;
  spec.name = std::move(name);
  spec.fallback = choices.front();
  spec.choices = std::move(choices);
  spec.meaning = std::move(meaning);
  spec.source = std::move(source);
  return spec;
}

ParameterSpec flag_parameter(std::string name, bool fallback, std::string meaning,
                             std::string source) {
  ParameterSpec spec;
  spec.name = std::move(name);
  spec.fallback = fallback;
  spec.meaning = std::move(meaning);
  spec.source = std::move(source);
  return spec;
}

}  // namespace simbench
