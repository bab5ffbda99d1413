#include "explore/parameters.h"

#include <string>
#include <utility>
#include <vector>

#include "algorithms/registry.h"
#include "explore/state.h"
#include "scenarios/changes.h"
#include "scenarios/loader.h"
#include "scenarios/schema.h"

namespace simbench::explore {
namespace {

using reports::Json;

constexpr std::size_t kLongestList = 64;

// What the schema says of a pointer; null if it says nothing.
const Json* schema_at(const std::string& pointer) {
  const Json* node = &scenarios::ordered_schema();
  Json::json_pointer rest(pointer);
  std::vector<std::string> keys;
  for (; !rest.empty(); rest.pop_back()) keys.push_back(rest.back());
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) {
    node = scenarios::schema_of_child(*node, *key);
    if (node == nullptr) return nullptr;
  }
  return node;
}

// The types that a value may have, without null.
std::vector<std::string> types_of(const Json& node, bool& or_null) {
  std::vector<std::string> types;
  const Json stated = node.value("type", Json());
  const auto add = [&](const Json& type) {
    if (type == "null") {
      or_null = true;
    } else if (type.is_string()) {
      types.push_back(type.get<std::string>());
    }
  };
  if (stated.is_array()) {
    for (const Json& type : stated) add(type);
  } else {
    add(stated);
  }
  return types;
}

const char* type_of_value(const Json& value) {
  if (value.is_boolean()) return "boolean";
  if (value.is_number_integer()) return "integer";
  if (value.is_number()) return "number";
  return value.is_structured() ? "list" : "text";
}

std::string shown_type(const std::vector<std::string>& types, const Json& node, const Json& value) {
  if (node.contains("enum")) return "word";
  if (types.size() != 1) return type_of_value(value);
  if (types.front() == "string") return "text";
  return types.front() == "array" || types.front() == "object" ? "list" : types.front();
}

void add_schema(const Json& node, const Json& value, Json& parameter) {
  bool or_null = false;
  const std::vector<std::string> types = types_of(node, or_null);
  parameter["type"] = shown_type(types, node, value);
  if (node.contains("minimum")) parameter["low"] = node.at("minimum");
  if (node.contains("maximum")) parameter["high"] = node.at("maximum");
  if (node.contains("enum")) {
    Json words = Json::array();
    for (const Json& word : node.at("enum")) {
      if (!word.is_null()) words.push_back(word);
    }
    parameter["words"] = std::move(words);
  }
  if (or_null) parameter["or_null"] = true;
}

bool is_settable(const std::string& pointer, const Json& value) {
  return is_of_a_world(pointer) && !scenarios::is_table(value) &&
         !(value.is_array() && value.size() > kLongestList);
}

}  // namespace

Json parameters_json(const scenarios::Scenario& scenario) {
  const Json document = Json::parse(scenario.resolved_json());
  Json all = Json::array();
  for (const scenarios::ParameterLine& line : scenarios::describe(scenario)) {
    const Json::json_pointer pointer(line.pointer);
    // A computed value is none of the document: it follows from others.
    if (!document.contains(pointer)) continue;
    const Json& value = document.at(pointer);
    if (!is_settable(line.pointer, value)) continue;
    Json parameter = {
        {"pointer", line.pointer}, {"value", value},
        {"unit", line.unit},       {"meaning", line.meaning},
        {"source", line.source},   {"group", line.pointer.substr(0, line.pointer.find('/', 1))}};
    if (const Json* const node = schema_at(line.pointer)) {
      add_schema(*node, value, parameter);
    } else {
      parameter["type"] = type_of_value(value);
    }
    all.push_back(std::move(parameter));
  }
  return all;
}

Json pipelines_json(const scenarios::Scenario& scenario) {
  Json pipelines = Json::array();
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    Json each = {{"name", pipeline.name},
                 {"host_sync", pipeline.host_sync},
                 {"device_time", pipeline.device_time},
                 {"gathering", pipeline.gathering}};
    if (!pipeline.capture_alignment.empty()) each["capture_alignment"] = pipeline.capture_alignment;
    if (pipeline.programs) each["programs"] = true;
    pipelines.push_back(std::move(each));
  }
  Json stages = Json::array();
  for (const StageInfo& stage : kPipelineStages) {
    Json algorithms = Json::array();
    for (const AlgorithmInfo* const info : algorithms_of(stage.id)) {
      algorithms.push_back({{"name", info->name}, {"summary", info->summary}});
    }
    stages.push_back({{"stage", stage.name}, {"algorithms", std::move(algorithms)}});
  }
  return {{"pipelines", std::move(pipelines)}, {"stages", std::move(stages)}};
}

}  // namespace simbench::explore
