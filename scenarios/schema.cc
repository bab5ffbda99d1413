#include "scenarios/schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <regex>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"
#include "scenarios/builtin_files.h"
#include "scenarios/schema_references.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// The keywords that are heeded, the texts, and what the parts of simbench that walk the schema of
// scenarios heed (docs/design.md section 7).
constexpr std::array kKeywords = {
    "type",      "enum",        "minimum",     "maximum",        "exclusiveMinimum",
    "minLength", "maxLength",   "pattern",     "minItems",       "maxItems",
    "items",     "uniqueItems", "properties",  "maxProperties",  "required",
    "$schema",   "title",       "description", "default",        "additionalProperties",
    "x-source",  "x-optional",  "x-type",      "x-name",         "x-declares",
    "x-stage",   "x-ideal",     "x-stays",     "x-relay",        "x-scoring",
    "x-world",   "x-below",     "x-profile",   "x-zero-or-from", "x-kinds"};

// A keyword that nobody heeds would leave something unchecked.
void check_keywords(const json& node) {
  for (const auto& [keyword, value] : node.items()) {
    SIMBENCH_ASSERT(std::ranges::count(kKeywords, keyword) == 1,
                    "a schema has only keywords that simbench heeds");
    if (keyword == "properties") {
      for (const json& child : value) check_keywords(child);
    } else if ((keyword == "items" || keyword == "additionalProperties") && value.is_object()) {
      check_keywords(value);
    }
  }
}

bool has_type(const json& node, const std::string& name) {
  const auto types = node.find("type");
  if (types == node.end()) return false;
  return *types == name ||
         (types->is_array() && std::count(types->begin(), types->end(), name) > 0);
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
    if (has_type(node, "null")) kinds.emplace_back("null");
  }
  return fmt::format("{}", fmt::join(kinds, node.contains("enum") ? ", " : " or "));
}

SchemaProblem unknown_key(const std::string& pointer, const std::string& key, const json& node) {
  std::vector<std::string> known;
  for (const auto& [name, child] : node.at("properties").items()) known.push_back(name);
  const std::vector<std::string> similar = nearest(key, known);
  return {child_pointer(pointer, key),
          similar.empty()
              ? fmt::format("found an unknown key, allowed {}", fmt::join(known, ", "))
              : fmt::format("found an unknown key, did you mean {}?", fmt::join(similar, " or "))};
}

// Whether a text has as many characters as it may, not bytes.
bool has_length(const json& node, const std::string& text) {
  const auto count = static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
  if (count < node.value("minLength", std::size_t{0})) return false;
  if (node.contains("maxLength") && count > node["maxLength"].get<std::size_t>()) return false;
  return !node.contains("pattern") ||
         std::regex_search(text, std::regex(node["pattern"].get<std::string>()));
}

bool is_in_range(const json& node, double number) {
  if (node.contains("minimum") && number < node["minimum"].get<double>()) return false;
  if (node.contains("maximum") && number > node["maximum"].get<double>()) return false;
  return !node.contains("exclusiveMinimum") || number > node["exclusiveMinimum"].get<double>();
}

bool has_size(const json& node, const json& array) {
  if (array.size() < node.value("minItems", std::size_t{0})) return false;
  if (node.contains("maxItems") && array.size() > node["maxItems"].get<std::size_t>()) return false;
  if (!node.value("uniqueItems", false)) return true;
  return std::ranges::none_of(
      array, [&array](const json& item) { return std::ranges::count(array, item) > 1; });
}

// Types are strict: 1 is not "1".
bool has_type_of(const json& node, const json& value) {
  if (!node.contains("type")) return true;
  if (value.is_number_integer()) return has_type(node, "integer") || has_type(node, "number");
  return has_type(node, value.type_name());
}

// Whether a value is what the schema says, but for its members.
bool is_accepted(const json& node, const json& value) {
  if (!has_type_of(node, value)) return false;
  if (node.contains("enum") && std::ranges::count(node["enum"], value) == 0) return false;
  if (value.is_string()) return has_length(node, value.get_ref<const std::string&>());
  if (value.is_number()) return is_in_range(node, value.get<double>());
  if (value.is_array()) return has_size(node, value);
  return !value.is_object() || !node.contains("maxProperties") ||
         value.size() <= node["maxProperties"].get<std::size_t>();
}

// Collects the problems of a document, the innermost first.
class Check {
 public:
  explicit Check(Completeness completeness) : completeness_(completeness) {}

  void walk(const std::string& pointer, const json& node, const json& value) {
    if (!is_accepted(node, value)) {
      problems_.push_back(
          {pointer, fmt::format("found {}, allowed {}", shown(value), allowed(node))});
    } else if (value.is_array() && node.contains("items")) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        walk(fmt::format("{}/{}", pointer, i), node["items"], value[i]);
      }
    } else if (value.is_object()) {
      walk_members(pointer, node, value);
    }
  }

  std::vector<SchemaProblem> take() { return std::move(problems_); }

 private:
  void walk_members(const std::string& pointer, const json& node, const json& value) {
    for (const auto& [key, member] : value.items()) {
      const json* const child = schema_of_child(node, key);
      if (child != nullptr) walk(child_pointer(pointer, key), *child, member);
    }
    if (!node.contains("properties")) return;
    if (node.value("additionalProperties", json()) == json(false)) {
      for (const auto& [key, member] : value.items()) {
        if (!node["properties"].contains(key)) problems_.push_back(unknown_key(pointer, key, node));
      }
    }
    const json required = node.value("required", json::array());
    for (const auto& [key, child] : node["properties"].items()) {
      if (value.contains(key)) continue;
      const bool is_required = completeness_ == Completeness::kResolved
                                   ? !is_optional(child)
                                   : std::ranges::count(required, json(key)) > 0;
      if (!is_required) continue;
      problems_.push_back(
          {child_pointer(pointer, key), "found nothing, allowed " + allowed(child)});
    }
  }

  Completeness completeness_;
  std::vector<SchemaProblem> problems_;
};

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

JsonSchema::JsonSchema(json text) : text_(std::move(text)) {
  expand_references(text_);
  check_keywords(text_);
}

std::vector<SchemaProblem> JsonSchema::problems(const json& document,
                                                Completeness completeness) const {
  Check check(completeness);
  check.walk("", text_, document);
  return check.take();
}

void validate(const json& document, const JsonSchema& schema, const Places& places,
              Completeness completeness) {
  const std::vector<SchemaProblem> problems = schema.problems(document, completeness);
  if (problems.empty()) return;
  const auto& first = *std::ranges::min_element(problems, {}, [&](const SchemaProblem& problem) {
    return places.nearest(problem.pointer).line;
  });
  throw InputError(places.describe(first.pointer) + ": " + first.text);
}

void validate(const json& document, Completeness completeness, const Places& places) {
  static const JsonSchema schema{json(ordered_schema())};
  validate(document, schema, places, completeness);
}

ordered_json in_schema_order(const json& document) {
  return in_order_of(&ordered_schema(), document);
}

const ordered_json& ordered_schema() {
  static const ordered_json schema = [] {
    auto whole = ordered_json::parse(schema_text());
    expand_references(whole);
    return whole;
  }();
  return schema;
}

}  // namespace simbench::scenarios
