// Validation against scenarios/schema.json (or another schema of its kind), with messages for
// people: the validator finds the place, and the schema's own words for that place make the
// message, "found X, allowed Y".
#ifndef SIMBENCH_SCENARIOS_SCHEMA_H_
#define SIMBENCH_SCENARIOS_SCHEMA_H_

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/document.h"

namespace simbench::scenarios {

// A JSON Schema (draft-07) as a validator. Only schema.cc includes valijson.
class JsonSchema {
 public:
  // A value that was refused, and after it the values around it.
  struct Refusal {
    std::vector<std::string> keys;  // the way to it: keys and array indices
    std::string reason;
  };

  // A schema that valijson does not accept is a programming error.
  explicit JsonSchema(nlohmann::json text);
  ~JsonSchema();
  JsonSchema(const JsonSchema&) = delete;
  JsonSchema& operator=(const JsonSchema&) = delete;

  const nlohmann::json& text() const { return text_; }

  // All refusals; empty if the document is valid. Types are strict: 1 is not "1". Several threads
  // may call this.
  std::vector<Refusal> validate(const nlohmann::json& document) const;

 private:
  struct Compiled;
  nlohmann::json text_;
  std::unique_ptr<const Compiled> compiled_;
};

enum class Completeness {
  kDifferences,  // a file as written: the members that it states must be valid
  kResolved,     // every property of every object must be there, except those in "x-optional"
};

// Throws InputError about the first line that the schema refuses, scenarios/schema.json or the
// caller's.
void validate(const nlohmann::json& document, Completeness completeness, const Places& places);
void validate(const nlohmann::json& document, const JsonSchema& schema, const Places& places);

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

#endif  // SIMBENCH_SCENARIOS_SCHEMA_H_
