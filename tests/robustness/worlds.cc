#include "tests/robustness/worlds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/loader.h"
#include "scenarios/schema.h"

namespace simbench::robustness {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// A value for a number anywhere in its range: ends, magnitudes, and the neighbourhood of the good
// value.
double number_in(const ordered_json& schema, double good, Random& random) {
  const double low = schema.value("minimum", schema.value("exclusiveMinimum", -1e9));
  const double high = schema.value("maximum", schema.value("exclusiveMaximum", 1e9));
  double value = good;
  switch (random.below(6)) {
    case 0:
      value = low;
      break;
    case 1:
      value = high;
      break;
    case 2:
      value = random.between(low, high);
      break;
    case 3:
      value =
          random.log_between(1e-6, std::max(high, 1e-5)) * (low < 0 && random.one_in(2) ? -1 : 1);
      break;
    default:
      value = (good == 0 ? 1 : good) * random.log_between(0.1, 10);
  }
  return std::clamp(value, low, high);
}

// "integer", or that among others, as of a number that may be null.
bool is_whole(const ordered_json& type) {
  return type.is_array() ? std::ranges::count(type, "integer") > 0 : type == "integer";
}

json value_in(const ordered_json& schema, const json& good, Random& random) {
  if (const auto words = schema.find("enum"); words != schema.end()) {
    return (*words)[random.below(words->size())];
  }
  if (good.is_boolean()) return !good.get<bool>();
  const double number = number_in(schema, good.get<double>(), random);
  if (!is_whole(schema.at("type"))) return number;
  return static_cast<std::int64_t>(std::llround(number));
}

}  // namespace

Worlds::Worlds() {
  for (const char* const name :
       {"3cam_1host_30fps", "6cam_2host_30fps", "18cam_6host_45fps", "18cam_6host_45fps_lan",
        "9cam_3host_30fps_azure_kinect", "leaderboard_lan", "leaderboard_gathering",
        "18cam_6host_45fps_lan_hardware_clocks", "18cam_6host_45fps_wander_and_ramp",
        "18cam_6host_45fps_clock_step_during_capture", "18cam_6host_45fps_auto_exposure",
        "6host_star", "6host_lan_day", "6cam_mixed_rates_60fps"}) {
    const scenarios::Scenario scenario = scenarios::load_scenario(name);
    World& world = worlds_.emplace_back(World{.name = name, .pipelines = {}, .parameters = {}});
    for (const auto& pipeline : scenario.pipelines) world.pipelines.push_back(pipeline.name);
    collect("", json::parse(scenario.resolved_json()), scenarios::ordered_schema(),
            world.parameters);
  }
}

// The numbers, switches and words of the world itself.
void Worlds::collect(const std::string& pointer, const json& value, const ordered_json& schema,
                     std::vector<Parameter>& parameters) {
  for (const char* const part :
       {"/pipelines", "/published", "/studio", "/algorithms", "/schema_version"}) {
    if (pointer == part) return;
  }
  if (value.is_structured()) {
    for (const auto& [key, member] : value.items()) {
      const ordered_json* const child = scenarios::schema_of_child(schema, key);
      if (child != nullptr) {
        collect(fmt::format("{}/{}", pointer, key), member, *child, parameters);
      }
    }
    return;
  }
  if (value.is_number() || value.is_boolean() || schema.contains("enum")) {
    parameters.push_back({pointer, value, &schema});
  }
}

std::vector<std::string> Worlds::next(Random& random) const {
  const World& world = random.of(worlds_);
  std::vector<std::string> arguments = {"simbench"};
  switch (random.below(5)) {
    case 0:
      arguments.insert(arguments.end(),
                       {"clocks", world.name, "--duration-s", "60", "--from-s", "10"});
      break;
    case 1:
      arguments.insert(arguments.end(), {"certify", world.name, "--estimated-stamp-ms", "0.02"});
      break;
    default:
      arguments.insert(arguments.end(), {"run", world.name});
  }
  const std::vector<std::string> more = {"--seeds",      "1",
                                         "--jobs",       "1",
                                         "--format",     random.one_in(2) ? "json" : "table",
                                         "--pipelines",  random.of(world.pipelines),
                                         "--first-seed", std::to_string(1 + random.below(1000)),
                                         "--set",        "/timeline/frames=20"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const std::size_t changes = 1 + random.below(6);
  for (std::size_t i = 0; i < changes; ++i) {
    const Parameter& parameter = random.of(world.parameters);
    arguments.emplace_back("--set");
    arguments.push_back(parameter.pointer + "=" +
                        value_in(*parameter.schema, parameter.value, random).dump());
  }
  return arguments;
}

}  // namespace simbench::robustness
