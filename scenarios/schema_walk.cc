#include "scenarios/schema_walk.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

void collect_pointers(const std::string& pointer, const ordered_json& node, const char* keyword,
                      const json& value, std::vector<std::string>& found) {
  if (node.contains(keyword) && json(node[keyword]) == value) found.push_back(pointer);
  if (!node.contains("properties")) return;
  for (const auto& [key, child] : node["properties"].items()) {
    collect_pointers(child_pointer(pointer, key), child, keyword, value, found);
  }
}

}  // namespace

bool schema_says(const char* keyword, std::string_view pointer) {
  const ordered_json* node = &ordered_schema();
  bool is_said = false;
  while (node != nullptr && pointer.starts_with('/')) {
    pointer.remove_prefix(1);
    const std::string key(pointer.substr(0, pointer.find('/')));
    pointer.remove_prefix(key.size());
    node = schema_of_child(*node, key);
    if (node != nullptr && node->contains(keyword)) {
      is_said = node->at(keyword) == ordered_json(true);
    }
  }
  return node != nullptr && is_said;
}

std::vector<std::string> pointers_that_say(const char* keyword, const json& value) {
  std::vector<std::string> found;
  collect_pointers("", ordered_schema(), keyword, value, found);
  return found;
}

}  // namespace simbench::scenarios
