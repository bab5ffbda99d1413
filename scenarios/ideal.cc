#include "scenarios/ideal.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/scenario_json.h"
#include "scenarios/schema.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

class Idealiser {
 public:
  explicit Idealiser(const std::vector<std::string_view>& stages) : stages_(stages) {}

  // `stage` is that of what the value is in.
  void walk(const ordered_json& node, const std::string& stage, json& value) const {
    if (value.is_array() && node.contains("items")) {
      walk_elements(node["items"], stage, value);
    } else if (value.is_object() && node.contains("properties")) {
      for (const auto& [key, child] : node["properties"].items()) {
        const std::string own = child.value("x-stage", stage);
        if (is_ideal(own) && child.contains("x-ideal")) {
          value[key] = child["x-ideal"];
        } else if (value.contains(key)) {
          walk(child, own, value[key]);
        }
      }
    }
  }

 private:
  void walk_elements(const ordered_json& node, const std::string& stage, json& elements) const {
    if (node.contains("x-kinds")) {
      std::erase_if(elements.get_ref<json::array_t&>(), [&](const json& element) {
        const ordered_json& kind = node["x-kinds"][element.at("kind").get<std::string>()];
        return is_ideal(kind.at("x-stage")) && kind.contains("x-ideal");
      });
    }
    for (json& element : elements) walk(node, node.value("x-stage", stage), element);
  }

  bool is_ideal(const std::string& stage) const {
    return std::ranges::find(stages_, stage) != stages_.end();
  }

  const std::vector<std::string_view>& stages_;
};

}  // namespace

Scenario with_ideal_stages(const Scenario& scenario, const std::vector<std::string_view>& stages) {
  json document = scenario;
  Idealiser(stages).walk(ordered_schema(), "none", document);
  Scenario world = scenario;
  document.get_to(world);
  world.pipelines = scenario.pipelines;  // programs have a host_sync that is not in the document
  return world;
}

}  // namespace simbench::scenarios
