// Walks over a scenario's JSON with what the schema says of each value: what is true of a member
// (its stage, whether a relay can carry it) stands in scenarios/schema.json alone.
//
//   const nlohmann::json document = scenario;
//   for_each_value("", ordered_schema(), document,
//                  [](const auto& pointer, const auto& node, const auto& value) {
//                    if (node.contains("x-relay")) print(pointer, value.dump());
//                  });
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/document.h"
#include "scenarios/schema.h"

namespace simbench::scenarios {

// Calls visit(pointer, node, value) for a value and all below it that the schema describes, the
// outer first. `node` is what the schema says of the value.
template <class Visit>
void for_each_value(const std::string& pointer, const nlohmann::ordered_json& node,
                    const nlohmann::json& value, const Visit& visit) {
  visit(pointer, node, value);
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) {
    const nlohmann::ordered_json* const child = schema_of_child(node, key);
    if (child != nullptr) for_each_value(child_pointer(pointer, key), *child, member, visit);
  }
}

// Whether the schema says `keyword`: true of the member at this pointer, or of what it is in. False
// of a pointer that the schema does not know.
bool schema_says(const char* keyword, std::string_view pointer);

// The pointers of the schema's properties that say `keyword`: `value` themselves.
std::vector<std::string> pointers_that_say(const char* keyword, const nlohmann::json& value);

}  // namespace simbench::scenarios
