#include "scenarios/resolve.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>

#include "scenarios/document.h"
#include "scenarios/overrides.h"
#include "scenarios/schema.h"

namespace simbench::scenarios {
namespace {

using nlohmann::json;

// One file as written, checked by itself.
struct Layer {
  json document;
  Places places;
};

Layer read_layer(const Source& source, std::size_t level) {
  const std::string label = source.is_builtin ? source.label : shown_text(source.label);
  Layer layer;
  try {
    Document parsed = parse_document(source.text);
    layer.document = std::move(parsed.root);
    for (const auto& [pointer, line] : parsed.lines) {
      layer.places.set(pointer, {.label = fmt::format("{}:{}", label, line),
                                 .set_pointer = "",
                                 .is_set = false,
                                 .is_builtin = source.is_builtin,
                                 .level = level,
                                 .line = line});
    }
  } catch (const DocumentError& error) {
    throw InputError(
        fmt::format("{}:{}:{}: {}", label, error.line(), error.column(), error.what()));
  }
  validate(layer.document, Completeness::kDifferences, layer.places);
  return layer;
}

// The file and its bases, the most basic one first.
std::vector<Layer> read_layers(Source source) {
  constexpr std::size_t kMostLayers = 32;
  std::vector<Layer> layers;
  std::vector<std::string> files;
  for (;;) {
    files.push_back(source.label);
    layers.push_back(read_layer(source, kMostLayers - layers.size()));
    const Layer& layer = layers.back();
    if (!layer.document.contains("base")) break;
    const std::string place = layer.places.describe("/base");
    Source base = find_base(source, layer.document["base"].get<std::string>(), place);
    if (std::find(files.begin(), files.end(), base.label) != files.end()) {
      throw InputError(fmt::format("{}: found a circle of bases: {} -> {}", place,
                                   fmt::join(files, " -> "), base.label));
    }
    if (layers.size() == kMostLayers) {
      throw InputError(
          fmt::format("{}: found more than {} bases upon each other", place, kMostLayers));
    }
    source = std::move(base);
  }
  std::reverse(layers.begin(), layers.end());
  return layers;
}

// RFC 7386, with the places beside the values.
void merge(const std::string& pointer, const json& patch, const Places& patch_places, json& target,
           Places& places) {
  if (!patch.is_object()) {
    target = patch;
    places.erase(pointer);
    places.adopt(pointer, patch_places);
    return;
  }
  if (!target.is_object()) {
    target = json::object();
    places.erase(pointer);
  }
  places.set(pointer, patch_places.nearest(pointer));
  for (const auto& [key, value] : patch.items()) {
    const std::string child = child_pointer(pointer, key);
    if (value.is_null()) {
      target.erase(key);
      places.erase(child);
    } else {
      merge(child, value, patch_places, target[key], places);
    }
  }
}

// A published result belongs to a pipeline: it does not outlive a base's pipelines.
void drop_outlived_results(const std::string& published, Resolved& resolved) {
  const json::json_pointer at(published);
  if (!resolved.document.contains(at)) return;
  const std::size_t pipelines_level = resolved.places->latest_level("/pipelines");
  json kept = json::object();
  for (const auto& [name, result] : resolved.document[at].items()) {
    const json& pipelines = resolved.document["pipelines"];
    const bool has_pipeline =
        std::any_of(pipelines.begin(), pipelines.end(),
                    [&wanted = name](const json& pipeline) { return pipeline["name"] == wanted; });
    const std::string pointer = child_pointer(published, name);
    if (has_pipeline || resolved.places->latest_level(pointer) >= pipelines_level) {
      kept[name] = result;
    } else {
      resolved.places->erase(pointer);
    }
  }
  resolved.document[at] = std::move(kept);
}

}  // namespace

Resolved resolve(Source source, const std::vector<Override>& overrides) {
  Resolved resolved;
  for (Layer& layer : read_layers(std::move(source))) {
    layer.document.erase("base");
    layer.document.erase("$schema");
    merge("", layer.document, layer.places, resolved.document, *resolved.places);
  }
  std::size_t level = resolved.places->latest_level("");
  for (const Override& setting : overrides) {
    apply_override(setting, ++level, resolved.document, *resolved.places);
  }
  validate(resolved.document, Completeness::kResolved, *resolved.places);
  drop_outlived_results("/published", resolved);
  drop_outlived_results("/studio/published", resolved);
  return resolved;
}

}  // namespace simbench::scenarios
