#include "scenarios/included_pipelines.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;

bool is_inclusion(const json& item) { return item.is_object() && item.contains("from"); }

bool is_called(const std::string& name, const std::string& pattern) {
  if (!pattern.ends_with('*')) return name == pattern;
  return name.starts_with(pattern.substr(0, pattern.size() - 1));
}

std::string name_of_row(const json& pipeline) {
  const auto name = pipeline.is_object() ? pipeline.find("name") : pipeline.end();
  return name != pipeline.end() && name->is_string() ? name->get<std::string>() : "";
}

// Takes a list of names out of the item; each of them must be a pipeline's.
std::vector<std::string> take_names(json& item, const std::string& member, const json& pipelines,
                                    const std::string& place) {
  const auto found = item.find(member);
  if (found == item.end()) return {};
  const json list = *found;
  item.erase(found);
  const bool is_list = list.is_array() &&
                       std::ranges::all_of(list, [](const json& each) { return each.is_string(); });
  if (!is_list) {
    throw InputError(
        fmt::format("{}/{}: found {}, allowed: a list of names", place, member, shown(list)));
  }
  auto names = list.get<std::vector<std::string>>();
  for (const std::string& name : names) {
    const bool is_known = std::ranges::any_of(
        pipelines, [&name](const json& each) { return is_called(name_of_row(each), name); });
    if (is_known) continue;
    throw InputError(
        fmt::format("{}/{}: found \"{}\", allowed: the name of a pipeline there, or its "
                    "begin and *",
                    place, member, shown_text(name)));
  }
  return names;
}

bool is_among(const json& pipeline, const std::vector<std::string>& names) {
  return std::ranges::any_of(names, [name = name_of_row(pipeline)](const std::string& pattern) {
    return is_called(name, pattern);
  });
}

// The pipelines that the item stands for.
std::vector<json> included(json item, const std::string& place, const PipelinesOf& pipelines_of) {
  const json from = std::exchange(item["from"], json());
  item.erase("from");
  if (!from.is_string()) {
    throw InputError(fmt::format("{}/from: found {}, allowed: a scenario", place, shown(from)));
  }
  const json pipelines = pipelines_of(from.get<std::string>(), place + "/from");
  const bool has_names = item.contains("names");
  const std::vector<std::string> names = take_names(item, "names", pipelines, place);
  const std::vector<std::string> except = take_names(item, "except", pipelines, place);
  std::vector<json> all;
  for (json pipeline : pipelines) {
    if ((has_names && !is_among(pipeline, names)) || is_among(pipeline, except)) continue;
    pipeline.update(item);
    all.push_back(std::move(pipeline));
  }
  if (all.empty()) {
    throw InputError(place + ": found no pipeline, allowed: names of which there is one");
  }
  return all;
}

// `names` and `except` choose among pipelines that `from` takes.
void check_pipeline(const json& item, const std::string& place) {
  if (!item.is_object()) return;
  for (const char* const member : {"names", "except"}) {
    if (!item.contains(member)) continue;
    throw InputError(fmt::format(
        "{}/{}: found without \"from\", allowed: beside the scenario that it chooses from", place,
        member));
  }
}

}  // namespace

void include_pipelines(PlacedDocument& file, const PipelinesOf& pipelines_of) {
  if (!file.root.is_object()) return;
  const auto items = file.root.find("pipelines");
  if (items == file.root.end() || !items->is_array()) return;
  for (std::size_t i = 0; i < items->size(); ++i) {
    if (is_inclusion((*items)[i])) continue;
    check_pipeline((*items)[i], file.places.describe(fmt::format("/pipelines/{}", i)));
  }
  if (std::ranges::none_of(*items, is_inclusion)) return;
  json all = json::array();
  const Places written = file.places;
  const auto add = [&](json pipeline, const std::string& item) {
    file.places.graft(item, written, fmt::format("/pipelines/{}", all.size()));
    all.push_back(std::move(pipeline));
  };
  file.places.erase("/pipelines");
  file.places.set("/pipelines", written.nearest("/pipelines"));
  for (std::size_t i = 0; i < items->size(); ++i) {
    const json& item = (*items)[i];
    const std::string pointer = fmt::format("/pipelines/{}", i);
    if (!is_inclusion(item)) {
      add(item, pointer);
      continue;
    }
    for (json& each : included(item, written.describe(pointer), pipelines_of)) {
      add(std::move(each), pointer);
    }
  }
  file.root["pipelines"] = std::move(all);
}

}  // namespace simbench::scenarios
