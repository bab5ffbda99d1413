#include "evaluation/run/ad_hoc_pipelines.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <nlohmann/json.hpp>

#include "algorithms/registry.h"
#include "scenarios/document.h"

namespace simbench::evaluation {
namespace {

using scenarios::InputError;
using scenarios::Override;
using scenarios::Pipeline;

constexpr char kBetween = '+';

std::vector<std::string> stages_of(const std::string& name) {
  std::vector<std::string> parts;
  boost::split(parts, name, [](char c) { return c == kBetween; });
  return parts;
}

bool is_ad_hoc(const std::string& name, AdHoc allowed) {
  if (name.find(kBetween) != std::string::npos) return true;
  return allowed == AdHoc::kHostSyncToo && find_host_sync(name) != nullptr;
}

Override appended(const std::string& name, const Pipeline& first, AdHoc allowed) {
  const std::string label = "--pipelines " + scenarios::shown_text(name);
  std::vector<std::string> parts = stages_of(name);
  if (parts.size() == 1) parts.insert(parts.end(), {first.device_time, first.gathering});
  const bool has_empty = std::ranges::count(parts, "") > 0;
  if (parts.size() != 3 || has_empty) {
    throw InputError(fmt::format(
        "{}: found {}, allowed: {}host_sync+device_time+gathering (`simbench list` names them)",
        label, has_empty ? "an empty part" : fmt::format("{} parts", parts.size()),
        allowed == AdHoc::kHostSyncToo ? "host_sync or " : ""));
  }
  const nlohmann::json pipeline = {
      {"name", name}, {"host_sync", parts[0]}, {"device_time", parts[1]}, {"gathering", parts[2]}};
  return {"/pipelines/-", pipeline.dump(), label};
}

}  // namespace

std::vector<Override> with_ad_hoc_pipelines(const std::string& scenario,
                                            std::vector<Override> overrides,
                                            const std::vector<std::string>& names, AdHoc allowed) {
  const auto stated = [allowed](const std::string& name) { return is_ad_hoc(name, allowed); };
  if (std::ranges::none_of(names, stated)) return overrides;
  const std::vector<Pipeline> pipelines = scenarios::load_scenario(scenario, overrides).pipelines;
  std::vector<std::string> known;
  known.reserve(pipelines.size() + names.size());
  for (const Pipeline& pipeline : pipelines) known.push_back(pipeline.name);
  for (const std::string& name : names) {
    if (!stated(name) || std::ranges::find(known, name) != known.end()) continue;
    known.push_back(name);
    overrides.push_back(appended(name, pipelines.front(), allowed));
  }
  return overrides;
}

}  // namespace simbench::evaluation
