#include "scenarios/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "scenarios/schema.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// A value of the base and what the schema says of it; null: unknown.
struct MergeTarget {
  std::string pointer;
  json& value;
  const ordered_json* node;
};

bool has_null(const json& value) {
  return value.is_null() || (value.is_object() && std::ranges::any_of(value, has_null));
}

const ordered_json* child_node(const ordered_json* node, const std::string& key) {
  return node == nullptr ? nullptr : schema_of_child(*node, key);
}

// Lists whose elements have names of their own.
bool goes_by_names(const ordered_json* list) {
  const ordered_json* const element = child_node(list, "");
  if (element == nullptr || !element->contains("properties")) return true;
  const ordered_json& members = element->at("properties");
  return members.contains("name") || members.contains("pipeline");
}

// Whether an element leaves out what it must have.
bool is_partial(const json& element, const ordered_json* list) {
  if (!element.is_object() || goes_by_names(list)) return false;
  const ordered_json& members = child_node(list, "")->at("properties");
  for (const auto& [key, member] : members.items()) {
    if (!is_optional(member) && !element.contains(key)) return true;
  }
  return false;
}

class Merge {
 public:
  Merge(const Places& patch_places, Places& places)
      : patch_places_(patch_places), places_(places) {}

  void apply(const json& patch, const MergeTarget& target) {
    if (patch.is_array() && target.value.is_array()) return apply_list(patch, target);
    const bool is_whole = !target.value.is_object() && !has_null(patch);
    if (!patch.is_object() || is_whole) return replace(patch, target);
    if (!target.value.is_object()) {
      target.value = json::object();
      places_.erase(target.pointer);
    }
    places_.set(target.pointer, patch_places_.nearest(target.pointer));
    for (const auto& [key, value] : patch.items()) {
      const std::string child = child_pointer(target.pointer, key);
      if (value.is_null()) {
        target.value.erase(key);
        places_.erase(child);
      } else {
        apply(value, {child, target.value[key], child_node(target.node, key)});
      }
    }
  }

 private:
  void replace(const json& patch, const MergeTarget& target) {
    target.value = patch;
    places_.erase(target.pointer);
    places_.adopt(target.pointer, patch_places_);
  }

  void apply_list(const json& patch, const MergeTarget& target) {
    const bool is_whole = std::ranges::none_of(
        patch, [&](const json& element) { return is_partial(element, target.node); });
    if (is_whole) return replace(patch, target);
    const json before = std::move(target.value);
    const Places places_before = places_;
    replace(patch, target);
    for (std::size_t i = 0; i < std::min(patch.size(), before.size()); ++i) {
      if (!before[i].is_object() || !is_partial(patch[i], target.node)) continue;
      const std::string pointer = fmt::format("{}/{}", target.pointer, i);
      json& element = target.value[i];
      element = before[i];
      places_.erase(pointer);
      places_.adopt(pointer, places_before);
      apply(patch[i], {pointer, element, child_node(target.node, "")});
    }
  }

  const Places& patch_places_;
  Places& places_;
};

}  // namespace

void merge_patch(const json& patch, const Places& patch_places, json& target, Places& places) {
  Merge(patch_places, places).apply(patch, {"", target, &ordered_schema()});
}

}  // namespace simbench::scenarios
