#include "app/sync_mode_worlds.h"

#include <fmt/format.h>

#include <algorithm>

#include "evaluation/run/ad_hoc_pipelines.h"
#include "scenarios/camera_profile.h"
#include "scenarios/loader.h"
#include "scenarios/words.h"

namespace simbench::app {
namespace {

using scenarios::Override;
using scenarios::Scenario;
using scenarios::StreamKind;
using scenarios::SyncMode;

// A mode with the paper's pipelines in it.
struct PaperMode {
  SyncMode mode;
  std::vector<scenarios::Pipeline> pipelines;
};

scenarios::Pipeline pipeline(const std::string& name, const std::string& host_sync,
                             const std::string& device_time, const std::string& gathering) {
  scenarios::Pipeline made;
  made.name = name;
  made.host_sync = host_sync;
  made.device_time = device_time;
  made.gathering = gathering;
  return made;
}

std::vector<PaperMode> paper_modes() {
  const scenarios::Pipeline method =
      pipeline("yoon2021_both", "yoon2021_both", "regression_30", "yoon2021");
  return {
      {SyncMode::kGenlock, {pipeline("genlock", "free_running", "sensor_normalised", "genlock")}},
      {SyncMode::kSlave, {method}},
      {SyncMode::kFullSlave,
       {method, pipeline("ntp_last_set", "ntp_last_set", "regression_30", "yoon2021")}}};
}

bool has_pipeline(const Scenario& scenario, const std::string& name) {
  return std::ranges::count(scenario.pipelines, name, &scenarios::Pipeline::name) > 0;
}

std::vector<Override> changes_of(const Scenario& scenario, const PaperMode& paper) {
  std::vector<Override> changes;
  const bool genlock = paper.mode == SyncMode::kGenlock;
  if (scenario.cameras.sync_mode != paper.mode) {
    const double rate_hz = scenario.cameras.stream(StreamKind::kDepth)->mode_rate_hz;
    changes.push_back({"/cameras/sync_mode", std::string(to_text(paper.mode))});
    changes.push_back({"/trigger/rate_hz", fmt::format("{}", genlock ? rate_hz / 2 : rate_hz)});
    if (genlock) changes.push_back({"/cameras/common_start", "true"});
  }
  // Colour has no pulse in GenLock and Slave; the frames of both streams are kept anyway.
  if (scenario.evaluation.stream != StreamKind::kDepth) {
    changes.push_back({"/evaluation/stream", "depth"});
  }
  for (const scenarios::Pipeline& each : paper.pipelines) {
    if (has_pipeline(scenario, each.name)) continue;
    changes.push_back({"/pipelines/-", evaluation::pipeline_json(each)});
  }
  return changes;
}

}  // namespace

std::vector<ModeWorld> sync_mode_worlds(const Scenario& scenario,
                                        std::vector<std::string>& problems) {
  const scenarios::Cameras& cameras = scenario.cameras;
  if (cameras.stream(StreamKind::kDepth) == nullptr) return {};
  if (cameras.stream(StreamKind::kColour) == nullptr) return {};
  const scenarios::CameraProfile& profile = *scenarios::find_camera_profile(cameras.model);
  std::vector<ModeWorld> worlds;
  for (const PaperMode& paper : paper_modes()) {
    if (profile.sync_mode(paper.mode) == nullptr) continue;
    try {
      ModeWorld world{.scenario = scenarios::load_scenario_text(
                          scenario.resolved_json(), scenario.name, changes_of(scenario, paper)),
                      .pipelines = {}};
      for (const scenarios::Pipeline& each : paper.pipelines) world.pipelines.push_back(each.name);
      worlds.push_back(std::move(world));
    } catch (const scenarios::InputError& error) {
      problems.push_back(
          fmt::format("sync mode {} is left out: {}", to_text(paper.mode), error.what()));
    }
  }
  return worlds;
}

}  // namespace simbench::app
