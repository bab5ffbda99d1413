#include "scenarios/schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "scenarios/builtin_files.h"

namespace simbench::scenarios {

using valijson::adapters::NlohmannJsonAdapter;

struct JsonSchema::Compiled {
  explicit Compiled(const nlohmann::json& text) {
    const NlohmannJsonAdapter adapter(text);
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(adapter, schema);
  }
  valijson::Schema schema;
};

JsonSchema::JsonSchema(nlohmann::json text)
    : text_(std::move(text)), compiled_(std::make_unique<const Compiled>(text_)) {}

JsonSchema::~JsonSchema() = default;

std::vector<JsonSchema::Refusal> JsonSchema::validate(const nlohmann::json& document) const {
  valijson::Validator validator;
  valijson::ValidationResults results;
  const NlohmannJsonAdapter target(document);
  std::vector<Refusal> refusals;
  if (validator.validate(compiled_->schema, target, &results)) return refusals;
  for (const auto& error : results) {
    // The place is written as {"<root>", "[key]", "[0]"}.
    Refusal refusal{{}, error.description};
    for (std::size_t i = 1; i < error.context.size(); ++i) {
      refusal.keys.push_back(error.context[i].substr(1, error.context[i].size() - 2));
    }
    refusals.push_back(std::move(refusal));
  }
  return refusals;
}

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// Makes every property of every object required, except those in the schema's "x-optional".
void require_all(json& node) {
  if (node.contains("properties")) {
    const json optional = node.value("x-optional", json::array());
    json required = json::array();
    for (auto& [key, child] : node["properties"].items()) {
      if (std::find(optional.begin(), optional.end(), key) == optional.end()) {
        required.push_back(key);
      }
      require_all(child);
    }
    node["required"] = std::move(required);
  }
  for (const char* const container : {"items", "additionalProperties"}) {
    if (node.contains(container) && node[container].is_object()) require_all(node[container]);
  }
}

// Replaces each {"$ref": "#/definitions/NAME", ...} by that definition, and merges the members
// beside the reference into it (the texts for this place).
void expand(ordered_json& node, const ordered_json& definitions) {
  if (node.is_object() && node.contains("$ref")) {
    constexpr std::string_view kDefinitions = "#/definitions/";
    const auto name = node["$ref"].get<std::string>().substr(kDefinitions.size());
    ordered_json whole = definitions.at(name);
    node.erase("$ref");
    whole.merge_patch(node);
    node = std::move(whole);
  }
  if (!node.is_structured()) return;
  for (ordered_json& child : node) expand(child, definitions);
}

json schema_for(Completeness completeness) {
  json schema = ordered_schema();
  if (completeness == Completeness::kResolved) require_all(schema);
  return schema;
}

const JsonSchema& checker(Completeness completeness) {
  static const JsonSchema differences(schema_for(Completeness::kDifferences));
  static const JsonSchema resolved(schema_for(Completeness::kResolved));
  return completeness == Completeness::kResolved ? resolved : differences;
}

bool has_type(const json& node, const std::string& name) {
  const json types = node.value("type", json());
  return types == name || (types.is_array() && std::count(types.begin(), types.end(), name) > 0);
}

std::string range_of(const json& node) {
  if (node.contains("exclusiveMinimum")) {
    return fmt::format(" above {} and at most {}", node["exclusiveMinimum"].dump(),
                       node["maximum"].dump());
  }
  if (!node.contains("minimum")) return "";
  if (node["minimum"] == node["maximum"]) return " equal to " + node["minimum"].dump();
  return fmt::format(" from {} to {}", node["minimum"].dump(), node["maximum"].dump());
}

// The allowed values of a place, in words.
std::string allowed(const json& node) {
  std::vector<std::string> kinds;
  if (node.contains("enum")) {
    for (const json& value : node["enum"]) kinds.push_back(value.dump());
  } else {
    if (has_type(node, "object")) kinds.emplace_back("an object");
    if (has_type(node, "array")) {
      kinds.push_back(fmt::format("an array of {} to {}", node.value("minItems", 0),
                                  node.value("maxItems", 0)));
    }
    if (has_type(node, "integer")) kinds.push_back("a whole number" + range_of(node));
    if (has_type(node, "number")) kinds.push_back("a number" + range_of(node));
    if (has_type(node, "boolean")) kinds.emplace_back("true or false");
    if (has_type(node, "string")) {
      kinds.push_back(node.contains("maxLength")
                          ? fmt::format("text of {} to {} characters", node.value("minLength", 0),
                                        node.value("maxLength", 0))
                          : "text");
    }
  }
  return fmt::format("{}", fmt::join(kinds, node.contains("enum") ? ", " : " or "));
}

struct Problem {
  std::string pointer;
  std::string text;
};

Problem unknown_key(const std::string& pointer, const std::string& key, const json& node) {
  std::vector<std::string> known;
  for (const auto& [name, child] : node["properties"].items()) known.push_back(name);
  const std::vector<std::string> similar = nearest(key, known);
  return {child_pointer(pointer, key),
          similar.empty()
              ? fmt::format("found an unknown key, allowed {}", fmt::join(known, ", "))
              : fmt::format("found an unknown key, did you mean {}?", fmt::join(similar, " or "))};
}

// The problems of a value itself, without those of its members.
std::vector<Problem> problems_at(const std::string& pointer, const json& node, const json& value) {
  std::vector<Problem> problems;
  if (value.is_object() && has_type(node, "object")) {
    if (!node.contains("properties")) return problems;
    for (const auto& [key, member] : value.items()) {
      if (!node["properties"].contains(key)) problems.push_back(unknown_key(pointer, key, node));
    }
    for (const json& key : node.value("required", json::array())) {
      if (value.contains(key)) continue;
      const auto name = key.get<std::string>();
      problems.push_back({child_pointer(pointer, name),
                          "found nothing, allowed " + allowed(node["properties"][name])});
    }
    return problems;
  }
  if (value.is_array() && has_type(node, "array") &&
      value.size() >= node.value("minItems", std::size_t{0}) &&
      value.size() <= node.value("maxItems", std::size_t{0})) {
    return problems;
  }
  problems.push_back({pointer, fmt::format("found {}, allowed {}", shown(value), allowed(node))});
  return problems;
}

// The problems where the schema refused the document.
std::vector<Problem> problems_of(const JsonSchema::Refusal& refusal, const json& schema,
                                 const json& document) {
  const json* node = &schema;
  const json* value = &document;
  std::string pointer;
  for (const std::string& key : refusal.keys) {
    node = schema_of_child(*node, key);
    if (node == nullptr) return {};
    value = value->is_array() ? &value->at(std::stoul(key)) : &value->at(key);
    pointer = child_pointer(pointer, key);
  }
  return problems_at(pointer, *node, *value);
}

ordered_json in_order_of(const ordered_json* node, const json& value) {
  if (!value.is_structured()) return value;
  auto result = value.is_array() ? ordered_json::array() : ordered_json::object();
  const auto child = [node](const std::string& key) {
    return node == nullptr ? nullptr : schema_of_child(*node, key);
  };
  if (value.is_array()) {
    for (const json& element : value) result.push_back(in_order_of(child(""), element));
    return result;
  }
  if (node != nullptr && node->contains("properties")) {
    for (const auto& [key, property] : node->at("properties").items()) {
      if (value.contains(key)) result[key] = in_order_of(&property, value[key]);
    }
    return result;
  }
  for (const auto& [key, member] : value.items()) result[key] = in_order_of(child(key), member);
  return result;
}

}  // namespace

void validate(const json& document, Completeness completeness, const Places& places) {
  validate(document, checker(completeness), places);
}

void validate(const json& document, const JsonSchema& schema, const Places& places) {
  const std::vector<JsonSchema::Refusal> refusals = schema.validate(document);
  if (refusals.empty()) return;

  std::optional<Problem> first;
  for (const JsonSchema::Refusal& refusal : refusals) {
    for (const Problem& problem : problems_of(refusal, schema.text(), document)) {
      if (!first || places.nearest(problem.pointer).line < places.nearest(first->pointer).line) {
        first = problem;
      }
    }
  }
  if (!first) first = Problem{"", "refused by the schema: " + refusals.front().reason};
  throw InputError(places.describe(first->pointer) + ": " + first->text);
}

ordered_json in_schema_order(const json& document) {
  return in_order_of(&ordered_schema(), document);
}

const ordered_json& ordered_schema() {
  static const ordered_json schema = [] {
    auto whole = ordered_json::parse(schema_text());
    const ordered_json definitions = whole.at("definitions");
    whole.erase("definitions");
    expand(whole, definitions);
    return whole;
  }();
  return schema;
}

}  // namespace simbench::scenarios
