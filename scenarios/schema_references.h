// The references of a JSON schema, put in place of what they name.
//
//   auto schema = nlohmann::ordered_json::parse(text);
//   expand_references(schema);  // {"$ref": "#/definitions/oscillator"} is now that definition
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace simbench::scenarios {

// Replaces each {"$ref": "#/definitions/NAME", ...} below `node` by that definition, and merges the
// members beside the reference into it (the texts for this place). Throws a JSON exception if there
// is no such definition.
template <class Json>
void expand_references(Json& node, const Json& definitions) {
  if (node.is_object() && node.contains("$ref")) {
    constexpr std::string_view kDefinitions = "#/definitions/";
    const auto name = node["$ref"].template get<std::string>().substr(kDefinitions.size());
    Json whole = definitions.at(name);
    node.erase("$ref");
    whole.merge_patch(node);
    node = std::move(whole);
  }
  if (!node.is_structured()) return;
  for (Json& child : node) expand_references(child, definitions);
}

// Expands the references of a whole schema, which then has no definitions.
template <class Json>
void expand_references(Json& schema) {
  if (!schema.contains("definitions")) return;
  const Json definitions = schema.at("definitions");
  schema.erase("definitions");
  expand_references(schema, definitions);
}

}  // namespace simbench::scenarios
