// Worlds that the schema permits, however strange, as command lines.
//
//   const Worlds worlds;
//   Ending ending = call({.arguments = worlds.next(random)});
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/robustness/random.h"

namespace simbench::robustness {

class Worlds {
 public:
  Worlds();

  // `simbench run` or `simbench clocks` of a built-in scenario and one of its pipelines, with one
  // to six parameters anywhere in their ranges.
  std::vector<std::string> next(Random& random) const;

 private:
  struct Parameter {
    std::string pointer;
    nlohmann::json value;
    const nlohmann::ordered_json* schema;
  };
  struct World {
    std::string name;
    std::vector<std::string> pipelines;
    std::vector<Parameter> parameters;
  };

  static void collect(const std::string& pointer, const nlohmann::json& value,
                      const nlohmann::ordered_json& schema, std::vector<Parameter>& parameters);

  std::vector<World> worlds_;
};

}  // namespace simbench::robustness
