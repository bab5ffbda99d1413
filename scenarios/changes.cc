#include "scenarios/changes.h"

#include <fmt/format.h>

#include "scenarios/document.h"
#include "scenarios/schema.h"
#include "scenarios/schema_walk.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t kLongestListed = 32;

// Leaves out what is no part of the world; pipelines are compared by name.
json world_of(json scenario) {
  static const std::vector<std::string> no_world = pointers_that_say("x-world", false);
  for (const std::string& pointer : no_world) {
    const json::json_pointer at(pointer);
    if (scenario.contains(at)) scenario[at.parent_pointer()].erase(at.back());
  }
  return scenario;
}

// Whether its members are compared one by one: an object, or a list of objects.
template <class Json>
bool has_members(const Json* value) {
  if (value == nullptr) return false;
  return value->is_object() || (value->is_array() && !value->empty() && value->front().is_object());
}

template <class Json>
std::string text_or_nothing(const Json* value) {
  return value == nullptr ? "" : value->dump();
}

// The member, or the element at that place; null: not there.
template <class Json>
const Json* member(const Json* value, const std::string& key) {
  if (value == nullptr || !value->is_object()) return nullptr;
  const auto found = value->find(key);
  return found == value->end() ? nullptr : &*found;
}
template <class Json>
const Json* element_at(const Json* value, std::size_t index) {
  if (value == nullptr || !value->is_array() || index >= value->size()) return nullptr;
  return &(*value)[index];
}

// Null: not there. Elements of lists by their place.
template <class Json>
void compare(const std::string& pointer, const Json* from, const Json* to,
             std::vector<Change>& changes) {
  if (from != nullptr && to != nullptr && *from == *to) return;
  if (!has_members(from) && !has_members(to)) {
    changes.push_back({pointer, text_or_nothing(from), text_or_nothing(to)});
    return;
  }
  for (std::size_t i = 0; element_at(from, i) != nullptr || element_at(to, i) != nullptr; ++i) {
    compare(fmt::format("{}/{}", pointer, i), element_at(from, i), element_at(to, i), changes);
  }
  if (to != nullptr && to->is_object()) {
    for (const auto& [key, value] : to->items()) {
      compare(child_pointer(pointer, key), member(from, key), &value, changes);
    }
  }
  if (from != nullptr && from->is_object()) {
    for (const auto& [key, value] : from->items()) {
      if (member(to, key) == nullptr) {
        compare<Json>(child_pointer(pointer, key), &value, nullptr, changes);
      }
    }
  }
}

}  // namespace

std::vector<Change> world_changes(const json& from, const json& to) {
  if (from == to) return {};
  const json before = world_of(from);
  const json after = world_of(to);
  std::vector<Change> changes;
  if (before == after) return changes;
  const ordered_json ordered_before = in_schema_order(before);
  const ordered_json ordered_after = in_schema_order(after);
  compare("", &ordered_before, &ordered_after, changes);
  return changes;
}

bool same_world(const json& from, const json& to) {
  if (from == to) return true;
  const json before = world_of(from);
  const json after = world_of(to);
  std::vector<Change> changes;
  compare("", &before, &after, changes);
  return changes.empty();
}

std::vector<Change> pipeline_changes(const json& from, const json& to) {
  std::vector<Change> changes;
  if (!to.contains("pipelines")) return changes;
  const json& pipelines = to["pipelines"];
  for (std::size_t i = 0; i < pipelines.size(); ++i) {
    const json* const before = find_pipeline(from, pipelines[i]["name"].get<std::string>());
    if (before == nullptr || *before == pipelines[i]) continue;
    const ordered_json ordered_before = *before;
    const ordered_json ordered_after = pipelines[i];
    compare(fmt::format("/pipelines/{}", i), &ordered_before, &ordered_after, changes);
  }
  return changes;
}

const json* find_pipeline(const json& scenario, const std::string& name) {
  if (!scenario.contains("pipelines")) return nullptr;
  for (const json& pipeline : scenario["pipelines"]) {
    if (pipeline.value("name", "") == name) return &pipeline;
  }
  return nullptr;
}

bool is_table(const ordered_json& value) {
  return value.is_array() && value.size() > kLongestListed && value.front().is_number();
}

std::string value_text(const ordered_json& value) {
  if (is_table(value)) {
    return fmt::format("[{}, ..., {}] ({} numbers)", value.front().dump(), value.back().dump(),
                       value.size());
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace simbench::scenarios
