#include "scenarios/overrides.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/document.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;

// The keys of a pointer without its escapes.
std::vector<std::string> keys_of(const std::string& pointer, const std::string& label) {
  std::vector<std::string> keys;
  try {
    for (json::json_pointer rest(pointer); !rest.empty(); rest.pop_back()) {
      keys.insert(keys.begin(), rest.back());
    }
  } catch (const json::exception&) {
    keys.clear();
  }
  if (keys.empty()) {
    throw InputError(label + ": found no JSON pointer, allowed one such as /timeline/frames");
  }
  return keys;
}

json parse_value(const std::string& value, const std::string& label) {
  try {
    return parse_document(value).root;
  } catch (const DocumentError& error) {
    if (error.is_syntax()) return value;
    throw InputError(label + ": " + error.what());
  }
}

std::string no_such_key(const std::string& pointer, const std::string& key, const json& object) {
  std::vector<std::string> known;
  for (const auto& [name, member] : object.items()) known.push_back(name);
  const std::string parent = pointer.empty() ? "the scenario" : pointer;
  if (known.empty()) {
    return fmt::format("found no \"{}\" in {}, which is empty", shown_text(key), parent);
  }
  const std::vector<std::string> similar = nearest(key, known);
  return fmt::format("found no \"{}\" in {}, {} {}", shown_text(key), parent,
                     similar.empty() ? "allowed" : "did you mean",
                     similar.empty() ? fmt::format("{}", fmt::join(known, ", "))
                                     : fmt::format("{}?", fmt::join(similar, " or ")));
}

json& element(json& array, const std::string& pointer, const std::string& key,
              const std::string& label) {
  const bool is_index =
      !key.empty() && key.size() < 10 && (key == "0" || key[0] != '0') &&
      std::all_of(key.begin(), key.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (is_index && std::stoul(key) < array.size()) return array[std::stoul(key)];
  throw InputError(array.empty() ? fmt::format("{}: found no \"{}\" in {}, which is empty", label,
                                               shown_text(key), pointer)
                                 : fmt::format("{}: found no \"{}\" in {}, allowed 0 to {}", label,
                                               shown_text(key), pointer, array.size() - 1));
}

// A parameter of an algorithm need not be there yet.
bool is_algorithm_parameter(const std::vector<std::string>& keys) {
  return keys.size() == 3 && keys[0] == "algorithms" && !keys[1].empty() && !keys[2].empty();
}

}  // namespace

void apply_override(const Override& setting, std::size_t level, json& document, Places& places) {
  const std::string& pointer = setting.pointer;
  const std::string label =
      fmt::format("--set {}={}", shown_text(pointer), shown_text(setting.value));
  if (!is_utf8(pointer) || !is_utf8(setting.value)) {
    throw InputError(label + ": found bytes that are no UTF-8 text");
  }
  const std::vector<std::string> keys = keys_of(pointer, label);
  const json value = parse_value(setting.value, label);
  const bool may_create = is_algorithm_parameter(keys);

  json* target = &document;
  json* parent = nullptr;
  std::string walked;
  for (const std::string& key : keys) {
    parent = target;
    if (target->is_array()) {
      target = &element(*target, walked, key, label);
    } else if (target->is_object() && (target->contains(key) || may_create)) {
      target = &(*target)[key];
    } else if (target->is_object()) {
      throw InputError(label + ": " + no_such_key(walked, key, *target));
    } else {
      throw InputError(fmt::format("{}: found no \"{}\" in {}, which is a single value", label,
                                   shown_text(key), walked));
    }
    walked = child_pointer(walked, key);
    if (may_create && target->is_null()) *target = json::object();
  }

  if (value.is_null() && parent->is_object()) {
    parent->erase(keys.back());
  } else if (value.is_object()) {
    *target = json::object();
    target->merge_patch(value);  // takes the nulls out
  } else {
    *target = value;
  }
  places.erase(pointer);
  Place place;
  place.label = label;
  place.set_pointer = pointer;
  place.is_set = true;
  place.level = level;
  places.set(pointer, std::move(place));
}

}  // namespace simbench::scenarios
