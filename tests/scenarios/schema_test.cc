// The schema, what is made from it, and what it is checked with.
#include "scenarios/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/builtin_files.h"
#include "scenarios/document.h"
#include "scenarios/loader.h"
#include "scenarios/part.h"
#include "scenarios/scenario_json.h"
#include "scenarios/schema_references.h"
#include "scenarios/schema_walk.h"
#include "scenarios/study.h"
#include "tests/nonempty.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using testing::IsEmpty;

bool has_type(const ordered_json& node, const char* name) {
  const ordered_json type = node.value("type", ordered_json());
  return type == name || (type.is_array() && std::ranges::count(type, ordered_json(name)) > 0);
}

json example_of(const ordered_json& node);

// One fault of each kind, with the members that it needs.
json examples_of_kinds(const ordered_json& node) {
  json elements = json::array();
  for (const auto& [kind, of_kind] : node["x-kinds"].items()) {
    json element = {{"kind", kind}};
    for (const ordered_json& key : of_kind["needs"]) {
      const auto member = key.get<std::string>();
      element[member] = example_of(node["properties"][member]);
    }
    elements.push_back(std::move(element));
  }
  return elements;
}

// A value that states everything of which the schema knows.
json example_of(const ordered_json& node) {
  if (node.contains("enum")) return node["enum"][0];
  if (node.contains("properties")) {
    json object = json::object();
    for (const auto& [key, child] : node["properties"].items()) object[key] = example_of(child);
    return object;
  }
  if (has_type(node, "object")) return {{"a", example_of(node["additionalProperties"])}};
  if (has_type(node, "array")) {
    if (node["items"].contains("x-kinds")) return examples_of_kinds(node["items"]);
    return json::array({example_of(node["items"])});
  }
  if (has_type(node, "boolean") && !has_type(node, "number")) return false;
  if (has_type(node, "string") && !has_type(node, "number")) return "a";
  const double least = node.value("minimum", 0.0);
  const double most = node.value("maximum", 1.0);
  const double number = std::clamp(1.0, least, most);
  return has_type(node, "integer") ? json(static_cast<std::int64_t>(number)) : json(number);
}

// A scenario that states everything but what the loader resolves.
json full_document() {
  json document = example_of(ordered_schema());
  for (const char* const name : {"$schema", "base"}) document.erase(name);
  for (const char* const name : {"from", "names", "except"}) document["pipelines"][0].erase(name);
  return document;
}

template <class Visit>
void for_each_leaf_schema(const std::string& pointer, const ordered_json& node, Visit visit) {
  for (const char* const container : {"properties", "items", "additionalProperties"}) {
    if (!node.contains(container) || !node[container].is_object()) continue;
    if (container == std::string("properties")) {
      for (const auto& [key, child] : node[container].items()) {
        for_each_leaf_schema(child_pointer(pointer, key), child, visit);
      }
    } else {
      for_each_leaf_schema(pointer + "/*", node[container], visit);
    }
    return;
  }
  visit(pointer, node);
}

// Another value of the same type; for a choice, another of its words.
json changed(const json& value, const ordered_json& node) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_number()) return value.get<double>() + 1;
  if (!node.contains("enum")) return value.get<std::string>() + "x";
  const std::string word = value.get<std::string>();
  return node["enum"][0].get<std::string>() == word ? node["enum"][1] : node["enum"][0];
}

TEST(SchemaDrift, EveryLeafOfTheSchemaReachesTheStruct) {
  const json original = full_document();
  const json before = original.get<Scenario>();
  std::size_t leaves = 0;
  for_each_value("", ordered_schema(), original,
                 [&](const std::string& pointer, const ordered_json& node, const json& value) {
                   // The kind of a fault decides what its other members are.
                   if (value.is_structured() || pointer == "/schema_version") return;
                   if (pointer.starts_with("/faults/") && pointer.ends_with("/kind")) return;
                   ++leaves;
                   json document = original;
                   const json other = changed(value, node);
                   document.at(json::json_pointer(pointer)) = other;
                   const json after = document.get<Scenario>();
                   EXPECT_EQ(json::diff(before, after).size(), 1U) << pointer;
                   EXPECT_EQ(after.at(json::json_pointer(pointer)), other) << pointer;
                 });
  EXPECT_GT(leaves, 250U);
}

TEST(SchemaDrift, EveryMemberOfTheStructIsInTheSchema) {
  json written = full_document().get<Scenario>();
  written["schema_version"] = 1;
  EXPECT_NO_THROW(validate(written, Completeness::kResolved, Places()));
}

// A member that is not stated has the schema's default.
TEST(SchemaDrift, DefaultsAreThoseOfTheSchema) {
  std::size_t defaults = 0;
  for_each_value("", ordered_schema(), full_document(),
                 [&](const std::string& pointer, const ordered_json& node, const json&) {
                   if (!node.contains("default")) return;
                   ++defaults;
                   json document = full_document();
                   const json::json_pointer at(pointer);
                   document.at(at.parent_pointer()).erase(at.back());
                   const json without = document.get<Scenario>();
                   document.at(at.parent_pointer())[at.back()] = node["default"];
                   if (node["default"] == ordered_json::object()) return;  // has its own defaults
                   EXPECT_EQ(without, json(document.get<Scenario>())) << pointer;
                 });
  EXPECT_GT(defaults, 10U);
}

TEST(SchemaDrift, TablesOfStudiesHaveTheWordsOfTheirSchema) {
  const auto schema = ordered_json::parse(study_schema_text());
  EXPECT_EQ(schema.at("/properties/tables/items/enum"_json_pointer),
            ordered_json(all_texts<StudyTable>()));
}

TEST(SchemaDrift, CameraProfilesHaveTheWordsOfTheirSchema) {
  const auto schema = ordered_json::parse(camera_schema_text());
  const auto words = [&schema](const char* pointer) {
    return schema.at(ordered_json::json_pointer(pointer)).get<std::vector<std::string>>();
  };
  EXPECT_EQ(words("/properties/streams/items/properties/kind/enum"), all_texts<StreamKind>());
  EXPECT_EQ(words("/properties/streams/items/properties/shutter/enum"), all_texts<ShutterKind>());
  const std::string mode = "/properties/sync/properties/modes/items/properties/";
  EXPECT_EQ(words((mode + "mode/enum").c_str()), all_texts<SyncMode>());
  EXPECT_EQ(words((mode + "triggered/items/enum").c_str()), all_texts<StreamKind>());
}

TEST(Schema, EveryPropertyHasDescriptionSourceAndRange) {
  for_each_leaf_schema(
      "", ordered_schema(), [](const std::string& pointer, const ordered_json& node) {
        EXPECT_FALSE(node.value("description", "").empty()) << pointer;
        EXPECT_FALSE(node.value("x-source", "").empty()) << pointer;
        const ordered_json& type = node.at("type");
        if (type == "integer" || type == "number") {
          EXPECT_TRUE(node.contains("minimum") || node.contains("exclusiveMinimum")) << pointer;
          EXPECT_TRUE(node.contains("maximum")) << pointer;
        }
        if (type == "string") {
          EXPECT_TRUE(node.contains("enum") || node.contains("maxLength")) << pointer;
        }
      });
}

TEST(Schema, ObjectsAreClosed) {
  std::string text = ordered_schema().dump();
  std::size_t objects = 0;
  for (std::size_t at = 0; (at = text.find("\"properties\":", at)) != std::string::npos; ++at) {
    ++objects;
  }
  std::size_t closed = 0;
  for (std::size_t at = 0;
       (at = text.find("\"additionalProperties\":false", at)) != std::string::npos; ++at) {
    ++closed;
  }
  EXPECT_EQ(closed, objects);
}

// Erases each property below the value in turn and expects the message.
std::size_t expect_all_required(const std::string& pointer, const ordered_json& node,
                                const json& value, const json& original) {
  std::size_t required = 0;
  if (value.is_structured()) {
    for (const auto& [key, member] : value.items()) {
      const ordered_json* const child = schema_of_child(node, key);
      required += expect_all_required(child_pointer(pointer, key), *child, member, original);
    }
  }
  if (!value.is_object() || !node.contains("properties")) return required;
  for (const auto& [key, child] : node["properties"].items()) {
    if (is_optional(child) || !value.contains(key)) continue;
    json document = original;
    document.at(json::json_pointer(pointer)).erase(key);
    ++required;
    const std::string missed = child_pointer(pointer, key);
    try {
      validate(document, Completeness::kResolved, Places());
      ADD_FAILURE() << missed << " was not missed";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(missed + ": found nothing, allowed "),
                std::string::npos)
          << error.what();
    }
  }
  return required;
}

TEST(Schema, EveryPropertyIsRequiredOfAResolvedScenario) {
  const json original = full_document();
  EXPECT_GT(expect_all_required("", ordered_schema(), original, original), 200U);
}

// What a schema says and nobody heeds would be unchecked.
TEST(Schema, AKeywordThatNobodyHeedsStopsTheProgram) {
  EXPECT_DEATH(JsonSchema(json{{"type", "number"}, {"multipleOf", 2}}), "keywords");
  EXPECT_DEATH(JsonSchema(json{{"properties", {{"a", {{"minimun", 2}}}}}}), "keywords");
  EXPECT_DEATH(JsonSchema(json{{"items", {{"x-stag", "none"}}}}), "keywords");
}

TEST(Schema, TheProjectsSchemasHaveOnlyKeywordsThatAreHeeded) {
  for (const std::string_view text : {schema_text(), camera_schema_text(), oscillator_schema_text(),
                                      part_schema_text(), study_schema_text()}) {
    const JsonSchema schema(json::parse(text));
    EXPECT_FALSE(schema.problems(json::object()).empty());
  }
}

// Each keyword on its own: a value at the edge, and one beyond it.
TEST(Schema, EveryKeywordIsHeeded) {
  struct Case {
    json schema;
    json good;
    json bad;
  };
  const std::vector<Case> cases = {
      {{{"type", "number"}, {"minimum", 1}, {"maximum", 2}}, 1, 0.999},
      {{{"type", "number"}, {"minimum", 1}, {"maximum", 2}}, 2, 2.001},
      {{{"type", "number"}, {"exclusiveMinimum", 1}, {"maximum", 2}}, 1.001, 1},
      {{{"type", "number"}}, 1, "1"},
      {{{"type", "integer"}}, 1, 1.5},
      {{{"type", "boolean"}}, true, 1},
      {{{"type", "string"}}, "", 0},
      {{{"type", "array"}}, json::array(), json::object()},
      {{{"type", {"object", "null"}}}, nullptr, json::array()},
      {{{"type", "string"}, {"minLength", 2}, {"maxLength", 3}}, "ab", "a"},
      {{{"type", "string"}, {"minLength", 2}, {"maxLength", 3}}, "\u00e4\u00e4\u00e4", "abcd"},
      {{{"type", "string"}, {"pattern", "^[a-z]+$"}}, "ab", "a1"},
      {{{"enum", {"a", 1}}}, 1, "b"},
      {{{"type", "array"}, {"minItems", 1}, {"maxItems", 2}}, {1}, json::array()},
      {{{"type", "array"}, {"minItems", 1}, {"maxItems", 2}}, {1, 2}, {1, 2, 3}},
      {{{"type", "array"}, {"uniqueItems", true}}, {1, 2}, {1, 1}},
      {{{"type", "array"}, {"items", {{"type", "integer"}}}}, {1}, {1, "a"}},
      {{{"type", "object"}, {"maxProperties", 1}}, {{"a", 1}}, {{"a", 1}, {"b", 1}}},
      {{{"type", "object"}, {"properties", {{"a", {{"type", "integer"}}}}}},
       {{"a", 1}},
       {{"a", ""}}},
      {{{"properties", {{"a", json::object()}}}, {"required", {"a"}}}, {{"a", 1}}, {{"b", 1}}},
      {{{"properties", {{"a", json::object()}}}, {"additionalProperties", false}},
       {{"a", 1}},
       {{"b", 1}}},
      {{{"type", "object"}, {"additionalProperties", {{"type", "integer"}}}},
       {{"a", 1}},
       {{"a", ""}}}};
  for (const Case& each : nonempty(cases)) {
    const JsonSchema schema(each.schema);
    EXPECT_THAT(schema.problems(each.good), IsEmpty()) << each.schema;
    EXPECT_EQ(schema.problems(each.bad).size(), 1U) << each.schema;
  }
}

TEST(Schema, KeepsItsOrder) {
  const std::string text = load_scenario("18cam_6host_45fps").resolved_json();
  EXPECT_LT(text.find("\"schema_version\""), text.find("\"name\""));
  EXPECT_LT(text.find("\"timeline\""), text.find("\"hosts\""));
  EXPECT_LT(text.find("\"warm_up_ms\""), text.find("\"frames\""));
}

}  // namespace
}  // namespace simbench::scenarios
