#include "reports/comparison/comparison_scenarios.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "scenarios/document.h"
#include "scenarios/loader.h"

namespace simbench::reports {
namespace {

// Members by name, independent of their order in a file.
using SortedJson = nlohmann::json;

constexpr std::array<const char*, 4> kWords = {"name", "summary", "published", "schema_version"};

SortedJson parsed(const std::string& text) {
  SortedJson root = SortedJson::parse(text, nullptr, false);
  if (!root.is_object()) throw scenarios::InputError("a resolved scenario is not a JSON object");
  return root;
}

// Pipelines by name, so that an added pipeline moves no other.
SortedJson by_name(const SortedJson& pipelines) {
  SortedJson named = SortedJson::object();
  if (!pipelines.is_array()) return named;
  for (SortedJson pipeline : pipelines) {
    if (!pipeline.is_object() || !pipeline.contains("name")) continue;
    const SortedJson name = pipeline["name"];
    pipeline.erase("name");
    if (name.is_string()) named[name.get<std::string>()] = pipeline;
  }
  return named;
}

std::map<std::string, SortedJson> leaves(const SortedJson& value, const std::string& pointer) {
  std::map<std::string, SortedJson> all;
  if (!value.is_structured() || value.empty()) return {{pointer, value}};
  for (const auto& [key, member] : value.items()) {
    all.merge(leaves(member, scenarios::child_pointer(pointer, key)));
  }
  return all;
}

std::vector<std::string> differences(const SortedJson& a, const SortedJson& b,
                                     const std::string& pointer) {
  const std::map<std::string, SortedJson> left = leaves(a, pointer);
  const std::map<std::string, SortedJson> right = leaves(b, pointer);
  const auto shown = [](const std::map<std::string, SortedJson>& all, const std::string& at) {
    const auto found = all.find(at);
    return found == all.end() ? std::string("nothing") : scenarios::shown(found->second);
  };
  std::map<std::string, SortedJson> both = left;
  both.insert(right.begin(), right.end());
  std::vector<std::string> found;
  for (const auto& [at, value] : both) {
    const auto l = left.find(at);
    const auto r = right.find(at);
    if (l != left.end() && r != right.end() && l->second == r->second) continue;
    found.push_back(fmt::format("{}: {} against {}", at, shown(left, at), shown(right, at)));
  }
  return found;
}

// Removes the member from the scenario and returns it.
SortedJson taken(SortedJson& scenario, const char* key) {
  SortedJson member = scenario.contains(key) ? scenario[key] : SortedJson::object();
  scenario.erase(key);
  return member;
}

}  // namespace

ScenarioDifferences compare_scenarios(const std::string& a, const std::string& b) {
  ScenarioDifferences result;
  SortedJson left = parsed(a);
  SortedJson right = parsed(b);
  result.algorithms =
      differences(taken(left, "algorithms"), taken(right, "algorithms"), "/algorithms");
  const SortedJson left_pipelines = by_name(taken(left, "pipelines"));
  const SortedJson right_pipelines = by_name(taken(right, "pipelines"));
  for (const auto& [name, pipeline] : left_pipelines.items()) {
    if (!right_pipelines.contains(name)) continue;
    for (std::string& difference : differences(pipeline, right_pipelines[name],
                                               scenarios::child_pointer("/pipelines", name))) {
      result.algorithms.push_back(std::move(difference));
    }
  }
  for (const char* word : kWords) {
    left.erase(word);
    right.erase(word);
  }
  for (SortedJson* scenario : {&left, &right}) {
    // The choice of the printed table.
    if (scenario->contains("evaluation")) (*scenario)["evaluation"].erase("table");
  }
  result.world = differences(left, right, "");
  return result;
}

std::string digest_of_json(const std::string& text) {
  const boost::uuids::name_generator_sha1 generator(boost::uuids::ns::oid());
  return to_string(generator(SortedJson::parse(text).dump()));
}

std::string first_few(const std::vector<std::string>& differences) {
  constexpr std::size_t kFew = 8;
  const std::size_t count = std::min(kFew, differences.size());
  const auto end = differences.begin() + static_cast<std::ptrdiff_t>(count);
  std::string text = fmt::format("{}", fmt::join(differences.begin(), end, "; "));
  if (differences.size() > kFew) text += fmt::format("; and {} more", differences.size() - kFew);
  return text;
}

std::string seeds_text(const SeedRange& seeds) {
  if (seeds.count == 1) return fmt::format("{}", seeds.first);
  return fmt::format("{}-{}", seeds.first, seeds.first + seeds.count - 1);
}

SeedPairing pair_by_seed(const SeedRange& a, const SeedRange& b) {
  const std::uint64_t first = std::max(a.first, b.first);
  const std::uint64_t end = std::min(a.first + a.count, b.first + b.count);
  if (end <= first) return {};
  return {.skip_a = first - a.first, .skip_b = first - b.first, .count = end - first};
}

SeedPairing pair_by_index(const SeedRange& a, const SeedRange& b) {
  return {.skip_a = 0, .skip_b = 0, .count = std::min(a.count, b.count)};
}

}  // namespace simbench::reports
