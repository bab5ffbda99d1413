#include "scenarios/loader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "scenarios/builtin_files.h"
#include "scenarios/changes.h"
#include "scenarios/document.h"
#include "scenarios/included_pipelines.h"
#include "scenarios/merge.h"
#include "scenarios/oscillator_class.h"
#include "scenarios/scenario_json.h"
#include "scenarios/schema.h"

namespace simbench::scenarios {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Insertions, deletions, replacements and swaps of neighbours; upper and lower case count as equal.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  const auto equal = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  };
  // distance[i][j]: between the first i characters of a and the first j of b.
  std::vector<std::vector<std::size_t>> distance(a.size() + 1,
                                                 std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& here = distance[i][j];
      if (i == 0 || j == 0) {
        here = i + j;
        continue;
      }
      here = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1,
                       distance[i - 1][j - 1] + (equal(a[i - 1], b[j - 1]) ? 0 : 1)});
      if (i > 1 && j > 1 && equal(a[i - 1], b[j - 2]) && equal(a[i - 2], b[j - 1])) {
        here = std::min(here, distance[i - 2][j - 2] + 1);
      }
    }
  }
  return distance[a.size()][b.size()];
}

// The text of a scenario file and where it lies: built into the program, on disk, or in memory.
struct Source {
  std::string label;  // the file's name in messages
  std::string text;
  bool is_builtin = false;
};

std::optional<Source> find_builtin(const std::string& name) {
  for (const BuiltinFile& file : builtin_files()) {
    if (file.name == name) {
      return Source{name + ".json", std::string(file.text), true};
    }
  }
  return std::nullopt;
}

std::string unknown_name(const std::string& name) {
  std::vector<std::string> known;
  for (const BuiltinFile& file : builtin_files()) known.emplace_back(file.name);
  const std::vector<std::string> similar = nearest(name, known);
  return fmt::format("found \"{}\", {} {} (or the path of a .json file)", shown_text(name),
                     similar.empty() ? "allowed" : "did you mean",
                     fmt::join(similar.empty() ? known : similar, similar.empty() ? ", " : " or "));
}

bool looks_like_path(const std::string& name) {
  return name.find('/') != std::string::npos || name.ends_with(".json");
}

// The user's built-in scenario, else a file. Throws InputError.
Source find_source(const std::string& name_or_path) {
  if (const auto builtin = find_builtin(name_or_path)) return *builtin;
  std::error_code ignored;
  if (looks_like_path(name_or_path) || fs::exists(name_or_path, ignored)) {
    return {name_or_path, read_input_file(name_or_path, shown_text(name_or_path), "scenario"),
            false};
  }
  throw InputError("scenario: " + unknown_name(name_or_path));
}

// The base of `from`; a path is relative to the folder of `from`. A scenario built into the program
// may only name another one. Throws InputError, whose message begins with `place`.
Source find_base(const Source& from, const std::string& base, const std::string& place) {
  if (const auto builtin = find_builtin(base)) return *builtin;
  if (from.is_builtin || !looks_like_path(base)) {
    throw InputError(place + ": " + unknown_name(base));
  }
  const std::string path = (fs::path(from.label).parent_path() / base).lexically_normal().string();
  const std::string prefix = fmt::format("{}: found \"{}\"", place, shown_text(base));
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    fail_to_read(prefix, "it is no regular file");
  }
  return {path, read_input_file(path, prefix, "scenario"), false};
}

[[noreturn]] void fail_in_circle(const std::string& place, const std::vector<std::string>& files,
                                 const std::string& again) {
  throw InputError(
      fmt::format("{}: found a circle of bases: {} -> {}", place, fmt::join(files, " -> "), again));
}

constexpr std::size_t kMostLayers = 32;

[[noreturn]] void fail_too_deep(const std::string& place) {
  throw InputError(fmt::format("{}: found more than {} bases upon each other", place, kMostLayers));
}

// The keys of a pointer, unescaped.
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

std::string no_such_key(const std::string& pointer, const std::string& key, const json& object,
                        std::vector<std::string> known) {
  std::erase_if(known, [&object](const std::string& name) { return object.contains(name); });
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

// "-" becomes the index of a new element.
json& element(json& array, const std::string& pointer, std::string& key, const std::string& label) {
  if (key == "-") {
    key = std::to_string(array.size());
    return array.emplace_back();
  }
  const bool is_index =
      !key.empty() && key.size() < 10 && (key == "0" || key[0] != '0') &&
      std::all_of(key.begin(), key.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (is_index && std::stoul(key) < array.size()) return array[std::stoul(key)];
  throw InputError(array.empty() ? fmt::format("{}: found no \"{}\" in {}, which is empty", label,
                                               shown_text(key), pointer)
                                 : fmt::format("{}: found no \"{}\" in {}, allowed 0 to {}", label,
                                               shown_text(key), pointer, array.size() - 1));
}

// A parameter of an algorithm need not exist yet.
bool is_algorithm_parameter(const std::vector<std::string>& keys) {
  return keys.size() == 3 && keys[0] == "algorithms" && !keys[1].empty() && !keys[2].empty();
}

// The members that the schema lets an object below the scenario do without.
std::vector<std::string> optional_members(const nlohmann::ordered_json* node) {
  if (node == nullptr || node == &ordered_schema()) return {};
  std::vector<std::string> members;
  if (!node->contains("properties")) return members;
  for (const auto& [key, child] : node->at("properties").items()) {
    if (is_optional(child)) members.push_back(key);
  }
  return members;
}

// --set /json/pointer=value: replaces the value at the pointer; null removes it. The value must
// exist, except for /algorithms/NAME/PARAMETER (the algorithms declare their own parameters and
// defaults) and for members that the schema calls optional. Throws InputError.
void apply_override(const Override& setting, std::size_t level, json& document, Places& places) {
  const std::string label =
      setting.label.empty()
          ? fmt::format("--set {}={}", shown_text(setting.pointer), shown_text(setting.value))
          : setting.label;
  if (!is_utf8(setting.pointer) || !is_utf8(setting.value)) {
    throw InputError(label + ": found bytes that are no UTF-8 text");
  }
  std::vector<std::string> keys = keys_of(setting.pointer, label);
  const json value = parse_value(setting.value, label);
  const bool is_parameter = is_algorithm_parameter(keys);

  json* target = &document;
  json* parent = nullptr;
  std::string walked;
  const nlohmann::ordered_json* schema = &ordered_schema();
  for (std::string& key : keys) {
    const std::vector<std::string> optional = optional_members(schema);
    const bool may_create = is_parameter || std::ranges::find(optional, key) != optional.end();
    parent = target;
    if (target->is_array()) {
      target = &element(*target, walked, key, label);
    } else if (target->is_object() && (target->contains(key) || may_create)) {
      target = &(*target)[key];
    } else if (target->is_object()) {
      throw InputError(label + ": " + no_such_key(walked, key, *target, optional));
    } else {
      throw InputError(fmt::format("{}: found no \"{}\" in {}, which is a single value", label,
                                   shown_text(key), walked));
    }
    walked = child_pointer(walked, key);
    if (schema != nullptr) schema = schema_of_child(*schema, key);
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
  places.erase(walked);
  Place place;
  place.label = label;
  place.set_pointer = walked;
  place.is_set = true;
  place.level = level;
  places.set(walked, std::move(place));
}

json pipelines_of(Source source, std::vector<std::string> files);

// One file as written, with the pipelines that it takes from others, checked by itself. `files` led
// here. Those built in are checked by tests/scenarios/builtin_test.cc.
PlacedDocument read_layer(const Source& source, std::size_t level,
                          const std::vector<std::string>& files) {
  PlacedDocument layer = parse_placed(
      source.text, {.label = source.is_builtin ? source.label : shown_text(source.label),
                    .is_builtin = source.is_builtin,
                    .level = level});
  include_pipelines(layer, [&](const std::string& scenario, const std::string& place) {
    Source other = find_base(source, scenario, place);
    if (std::ranges::count(files, other.label) > 0) fail_in_circle(place, files, other.label);
    if (files.size() >= kMostLayers) fail_too_deep(place);
    return pipelines_of(std::move(other), files);
  });
  if (!source.is_builtin) validate(layer.root, Completeness::kDifferences, layer.places);
  return layer;
}

// The file and its bases, the most basic one first.
std::vector<PlacedDocument> read_layers(Source source, std::vector<std::string> files = {}) {
  std::vector<PlacedDocument> layers;
  for (;;) {
    files.push_back(source.label);
    layers.push_back(read_layer(source, kMostLayers - layers.size(), files));
    const PlacedDocument& layer = layers.back();
    if (!layer.root.contains("base")) break;
    const std::string place = layer.places.describe("/base");
    Source base = find_base(source, layer.root["base"].get<std::string>(), place);
    if (std::ranges::count(files, base.label) > 0) fail_in_circle(place, files, base.label);
    if (layers.size() == kMostLayers) fail_too_deep(place);
    source = std::move(base);
  }
  std::reverse(layers.begin(), layers.end());
  return layers;
}

// Returns the pipelines that the scenario states or inherits; `files` led to it.
json pipelines_of(Source source, std::vector<std::string> files) {
  std::vector<PlacedDocument> layers = read_layers(std::move(source), std::move(files));
  while (!layers.empty() && !layers.back().root.contains("pipelines")) layers.pop_back();
  return layers.empty() ? json::array() : layers.back().root["pipelines"];
}

// A scenario as one of its files leaves it, before later files and overrides.
struct SourceLayer {
  std::size_t level = 0;
  bool is_builtin = false;
  json document;
  bool same_world = true;  // as that of the resolved scenario
};

// From a source to the resolved scenario as JSON.
struct Resolved {
  json document;  // complete and valid by the schema; without "base" and "$schema"
  std::shared_ptr<Places> places = std::make_shared<Places>();
  std::vector<SourceLayer> stages{};  // the most basic one first
  Derivation derivation{};

  // The scenario as the file of that level leaves it; null: a --set does, it is the resolved one.
  const SourceLayer* stage_of(std::size_t level) const {
    const auto found =
        std::find_if(stages.begin(), stages.end(),
                     [level](const SourceLayer& stage) { return stage.level == level; });
    return found == stages.end() ? nullptr : &*found;
  }
};

constexpr const char* kFigures = "published_figures";

// Whether a published result holds: in the world in which it is stated, of a pipeline with the
// stages that it has there. Notes in the derivation that one does not for the sake of its world.
bool holds(const std::string& name, const std::string& pointer, Resolved& resolved) {
  const std::size_t level = resolved.places->latest_level(pointer);
  const SourceLayer* const stage = resolved.stage_of(level);
  const json* const pipeline = find_pipeline(resolved.document, name);
  if (pipeline == nullptr) return level >= resolved.places->latest_level("/pipelines");
  if (stage == nullptr) return true;
  const json* const stated = find_pipeline(stage->document, name);
  if (stage->same_world) return stated == nullptr || *stated == *pipeline;
  resolved.derivation.unpublished = stage->document.value("name", "");
  return false;
}

// A published result goes with the base's pipelines and world.
void drop_outlived_results(const std::string& published, Resolved& resolved) {
  const json::json_pointer at(published);
  if (!resolved.document.contains(at)) return;
  json kept = json::object();
  for (const auto& [name, result] : resolved.document[at].items()) {
    const std::string pointer = child_pointer(published, name);
    if (holds(name, pointer, resolved)) {
      kept[name] = result;
    } else {
      resolved.places->erase(pointer);
    }
  }
  resolved.document[at] = std::move(kept);
}

// Drops the figures of pipelines that are gone. Figures that are kept move up, and so do their
// places.
void drop_outlived_figures(Resolved& resolved) {
  const auto found = resolved.document.find(kFigures);
  if (found == resolved.document.end()) return;
  const std::string list = fmt::format("/{}", kFigures);
  json kept = json::array();
  std::vector<Place> places;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const json& figure = found->at(i);
    const std::string pointer = fmt::format("{}/{}", list, i);
    if (!holds(figure.value("pipeline", ""), pointer, resolved)) continue;
    kept.push_back(figure);
    places.push_back(resolved.places->nearest(pointer));
  }
  if (kept.size() == found->size()) return;
  const Place whole = resolved.places->nearest(list);
  resolved.places->erase(list);
  if (kept.empty()) {
    resolved.document.erase(kFigures);
    return;
  }
  *found = std::move(kept);
  resolved.places->set(list, whole);
  for (std::size_t i = 0; i < places.size(); ++i) {
    resolved.places->set(fmt::format("{}/{}", list, i), std::move(places[i]));
  }
}

void drop_outlived_results(Resolved& resolved) {
  drop_outlived_results("/published", resolved);
  drop_outlived_results("/studio/published", resolved);
  drop_outlived_figures(resolved);
}

void derive(Resolved& resolved);

// Validates every file of a user's by itself, merges it over its base (merge.h), applies the
// overrides in their order, then the
// classes of oscillators, and validates the whole, unless it is a built-in scenario as it stands.
// Drops inherited published results whose pipelines or worlds are gone. Throws InputError.
Resolved resolve(Source source, const std::vector<Override>& overrides) {
  Resolved resolved;
  for (PlacedDocument& layer : read_layers(std::move(source))) {
    for (const std::string key : {"base", "$schema"}) {
      layer.root.erase(key);
      layer.places.erase('/' + key);
    }
    merge_patch(layer.root, layer.places, resolved.document, *resolved.places);
    const Place& file = layer.places.nearest("");
    json document = resolved.document;
    Places places = *resolved.places;
    apply_oscillator_classes(document, places);
    resolved.stages.push_back(
        {.level = file.level, .is_builtin = file.is_builtin, .document = std::move(document)});
  }
  std::size_t level = resolved.places->latest_level("");
  for (const Override& setting : overrides) {
    apply_override(setting, ++level, resolved.document, *resolved.places);
  }
  apply_oscillator_classes(resolved.document, *resolved.places);
  if (!resolved.stages.back().is_builtin || !overrides.empty()) {
    validate(resolved.document, Completeness::kResolved, *resolved.places);
  }
  for (SourceLayer& stage : resolved.stages) {
    const bool is_all = &stage == &resolved.stages.back() && overrides.empty();
    stage.same_world = is_all || same_world(stage.document, resolved.document);
  }
  drop_outlived_results(resolved);
  derive(resolved);
  return resolved;
}

// The pipelines with published figures.
std::set<std::string> pipelines_of_figures(const json& scenario) {
  std::set<std::string> names;
  if (!scenario.contains(kFigures)) return names;
  for (const json& figure : scenario[kFigures]) names.insert(figure.value("pipeline", ""));
  return names;
}

// Whether `base` has a published result of a pipeline of the scenario, which itself has none.
bool lacks_results_of(const json& base, const json& scenario) {
  for (const char* const published : {"/published", "/studio/published"}) {
    const json::json_pointer at(published);
    if (!base.contains(at) || !scenario.contains(at)) continue;
    for (const auto& [name, result] : base[at].items()) {
      if (!scenario[at].contains(name) && find_pipeline(scenario, name) != nullptr) return true;
    }
  }
  const std::set<std::string> stated = pipelines_of_figures(scenario);
  return std::ranges::any_of(pipelines_of_figures(base), [&](const std::string& name) {
    return !stated.contains(name) && find_pipeline(scenario, name) != nullptr;
  });
}

// The built-in scenarios as they resolve, for those that state a built-in scenario's name alone.
const Resolved& resolved_builtin(const std::string& name) {
  static std::mutex mutex;
  static std::map<std::string, Resolved> known;
  const std::lock_guard lock(mutex);
  const auto found = known.find(name);
  if (found != known.end()) return found->second;
  return known.emplace(name, resolve(*find_builtin(name), {})).first->second;
}

void set_changes(const json& base, Resolved& resolved) {
  Derivation& derivation = resolved.derivation;
  derivation.changes = world_changes(base, resolved.document);
  for (Change& change : pipeline_changes(base, resolved.document)) {
    derivation.changes.push_back(std::move(change));
  }
  const std::string name = base.value("name", "");
  if (!derivation.changes.empty() || name != resolved.document.value("name", "")) {
    derivation.base = name;
  }
}

// Sets what the scenario rests on (derivation.h).
void derive(Resolved& resolved) {
  const auto nearest_builtin =
      std::find_if(resolved.stages.rbegin(), resolved.stages.rend(),
                   [](const SourceLayer& stage) { return stage.is_builtin; });
  if (nearest_builtin != resolved.stages.rend()) {
    return set_changes(nearest_builtin->document, resolved);
  }
  const std::string name = resolved.document.value("name", "");
  if (!find_builtin(name)) return set_changes(resolved.stages.back().document, resolved);
  const Resolved& builtin = resolved_builtin(name);
  set_changes(builtin.document, resolved);
  Derivation& derivation = resolved.derivation;
  if (!derivation.changes.empty() && lacks_results_of(builtin.document, resolved.document)) {
    derivation.unpublished = name;
  }
  if (derivation.unpublished.empty()) derivation.unpublished = builtin.derivation.unpublished;
}

Lazy<std::string> text_of(json scenario) {
  return Lazy<std::string>(
      [document = std::move(scenario)] { return in_schema_order(document).dump(2) + '\n'; });
}

// Replaces a summary that was written for another world.
void renew_summary(Resolved& resolved, Scenario& scenario) {
  const SourceLayer* const stage = resolved.stage_of(resolved.places->nearest("/summary").level);
  if (stage == nullptr || stage->same_world) return;
  scenario.summary = world_text(scenario);
  resolved.document["summary"] = scenario.summary;
  scenario.resolved_json = text_of(resolved.document);
}

Scenario load(Source source, const std::vector<Override>& overrides) {
  Resolved resolved = resolve(std::move(source), overrides);
  auto scenario = resolved.document.get<Scenario>();
  scenario.derivation = resolved.derivation;
  scenario.resolved_json = text_of(resolved.document);
  scenario.origin = resolved.places;
  check(scenario, resolved.document);
  renew_summary(resolved, scenario);
  return scenario;
}

}  // namespace

Scenario load_scenario(const std::string& name_or_path, const std::vector<Override>& overrides) {
  return load(find_source(name_or_path), overrides);
}

Scenario load_scenario_text(const std::string& text, const std::string& file_name,
                            const std::vector<Override>& overrides) {
  return load(Source{file_name, text, false}, overrides);
}

std::vector<BuiltinScenario> builtin_scenarios() {
  std::vector<BuiltinScenario> scenarios;
  for (const BuiltinFile& file : builtin_files()) {
    const auto document = nlohmann::json::parse(file.text);
    scenarios.push_back({std::string(file.name), document.at("summary").get<std::string>()});
  }
  return scenarios;
}

void fail_at(const Scenario& scenario, const std::string& pointer, const std::string& problem) {
  throw InputError(scenario.origin->describe(pointer) + ": " + problem);
}

std::vector<std::string> nearest(const std::string& name, const std::vector<std::string>& known) {
  constexpr std::size_t kMost = 3;
  constexpr std::size_t kLongestName = 200;
  if (name.empty() || name.size() > kLongestName) return {};
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    // A name is similar if at most a third of it is wrong, or if it is a part of the candidate.
    const bool is_part = name.size() >= 3 && candidate.find(name) != std::string::npos;
    if (is_part || distance <= std::max<std::size_t>(1, candidate.size() / 3)) {
      found.emplace_back(distance, candidate);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  for (const auto& [distance, candidate] : found) {
    if (names.size() == kMost || distance > 2 * found.front().first) break;
    names.push_back(candidate);
  }
  return names;
}

}  // namespace simbench::scenarios
