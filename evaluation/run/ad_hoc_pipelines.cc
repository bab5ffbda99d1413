#include "evaluation/run/ad_hoc_pipelines.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <nlohmann/json.hpp>

#include "algorithms/ports/stage.h"
#include "algorithms/registry.h"
#include "recording/collected.h"
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
  return allowed == AdHoc::kHostSyncToo && find_algorithm<HostSyncEntry>(name) != nullptr;
}

Override appended(const std::string& name, const Pipeline& first, AdHoc allowed) {
  const std::string label = "--pipelines " + scenarios::shown_text(name);
  const std::vector<std::string> parts = stages_of(name);
  const bool has_empty = std::ranges::count(parts, "") > 0;
  if (parts.size() == 2 || parts.size() > kPipelineStages.size() || has_empty) {
    throw InputError(fmt::format(
        "{}: found {}, allowed: {}{} (`simbench list` names them)", label,
        has_empty ? "an empty part" : fmt::format("{} parts", parts.size()),
        allowed == AdHoc::kHostSyncToo ? "host_sync or " : "", stages_formula(kPipelineStages)));
  }
  Pipeline stated = first;
  auto part = parts.begin();
  for (const StageInfo& stage : kPipelineStages) {
    if (part == parts.end()) break;
    const bool is_left_out =
        stage.may_be_absent && parts.size() > 1 && parts.size() < kPipelineStages.size();
    at_stage(stated, stage.id) = is_left_out ? "" : *part++;
  }
  stated.name = name;
  return {"/pipelines/-", pipeline_json(stated), label};
}

}  // namespace

std::string pipeline_json(const Pipeline& pipeline) {
  nlohmann::json stated = {{"name", pipeline.name}};
  for (const StageInfo& stage : kPipelineStages) {
    const std::string& algorithm = at_stage(pipeline, stage.id);
    if (!algorithm.empty()) stated[stage.name] = algorithm;
  }
  return stated.dump();
}

std::vector<Override> with_ad_hoc_pipelines(const std::string& scenario,
                                            std::vector<Override> overrides,
                                            const std::vector<std::string>& names, AdHoc allowed) {
  const auto stated = [allowed](const std::string& name) { return is_ad_hoc(name, allowed); };
  if (std::ranges::none_of(names, stated)) return overrides;
  const std::vector<Pipeline> pipelines = scenarios::load_scenario(scenario, overrides).pipelines;
  std::vector<std::string> known = collected(pipelines, &Pipeline::name);
  for (const std::string& name : names) {
    if (!stated(name) || std::ranges::find(known, name) != known.end()) continue;
    known.push_back(name);
    overrides.push_back(appended(name, pipelines.front(), allowed));
  }
  return overrides;
}

}  // namespace simbench::evaluation
