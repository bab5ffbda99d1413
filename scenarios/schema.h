// Validation against scenarios/schema.json (or another schema of its kind), with messages for
// people: one walk finds what is wrong, and the schema's own words for that place make the message,
// "found X, allowed Y".
//
// A schema is JSON Schema (draft-07) of those keywords that the project's schemas use. A keyword
// that this walk does not heed is a programming error, so that nothing is silently unchecked.
//
//   static const JsonSchema schema(nlohmann::json::parse(part_schema_text()));
//   const PlacedDocument document = parse_placed(text, {.label = "my_part.json"});
//   validate(document.root, schema, document.places);
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/document.h"

namespace simbench::scenarios {

enum class Completeness {
  kDifferences,  // a file as written: the members that it states must be valid
  kResolved,     // every property of every object must be there, but for the optional ones
};

// Something that a schema refuses: where, and what was found and is allowed.
struct SchemaProblem {
  std::string pointer;
  std::string text;
};

class JsonSchema {
 public:
  explicit JsonSchema(nlohmann::json text);

  // All problems; empty if the document is valid. Linear in the document. Several threads may call
  // this.
  std::vector<SchemaProblem> problems(const nlohmann::json& document,
                                      Completeness completeness = Completeness::kDifferences) const;

 private:
  nlohmann::json text_;  // with its references resolved
};

// Whether a property may be left out: it has a default, may be null, or is called "x-optional".
template <class Json>
bool is_optional(const Json& node) {
  if (node.contains("default") || node.value("x-optional", false)) return true;
  const Json types = node.value("type", Json());
  return types.is_array() && std::ranges::count(types, Json("null")) > 0;
}

// Throws InputError about the first line that the schema refuses, scenarios/schema.json or the
// caller's.
void validate(const nlohmann::json& document, Completeness completeness, const Places& places);
void validate(const nlohmann::json& document, const JsonSchema& schema, const Places& places,
              Completeness completeness = Completeness::kDifferences);

// What the schema cannot say: throws InputError about the first members that contradict each other.
// `document` is the scenario as JSON.
void check(const Scenario& scenario, const nlohmann::json& document);

// scenarios/schema.json with its references resolved and its properties in the order of the file.
const nlohmann::ordered_json& ordered_schema();

// The same value with its keys in the order of the schema.
nlohmann::ordered_json in_schema_order(const nlohmann::json& document);

// The part of the schema that describes the value at `key` of what `node` describes: a property, an
// element, or a member of a map. Null if there is none.
template <class Json>
const Json* schema_of_child(const Json& node, const std::string& key) {
  for (const char* const container : {"properties", "items", "additionalProperties"}) {
    const auto found = node.find(container);
    if (found == node.end() || !found->is_object()) continue;
    if (container != std::string("properties")) return &*found;
    if (const auto child = found->find(key); child != found->end()) return &*child;
  }
  return nullptr;
}

}  // namespace simbench::scenarios
