// What the world does, event by event, must not change by accident, nor with the compiler, its
// flags or sanitizers: the trace hash of a short run of every built-in scenario. A change that is
// meant changes these numbers; say why in its commit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithms/registry.h"
#include "recording/kept_recording.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::sim {
namespace {

struct Golden {
  std::string scenario;
  std::string pipeline;
  std::uint64_t events;
  std::uint64_t trace_hash;
};

// A tenth of the scale scenario is enough of it.
std::vector<scenarios::Override> brief(const std::string& scenario) {
  std::vector<scenarios::Override> overrides = {{"/timeline/frames", "20"},
                                                {"/timeline/warm_up_ms", "500"}};
  if (scenario.starts_with("scale_")) {
    overrides.push_back({"/hosts/count", "60"});
    overrides.push_back({"/cameras/count", "180"});
  }
  return overrides;
}

const scenarios::Pipeline& pipeline_of(const scenarios::Scenario& scenario,
                                       const std::string& name) {
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    if (pipeline.name == name) return pipeline;
  }
  return scenario.pipelines.at(0);
}

RecordingCost run(const Golden& golden) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(golden.scenario, brief(golden.scenario));
  const scenarios::Pipeline& pipeline = pipeline_of(scenario, golden.pipeline);
  const HostSyncEntry* entry = find_host_sync(pipeline.host_sync);
  ParameterValues values;
  if (const auto given = scenario.algorithms.find(entry->info.family);
      given != scenario.algorithms.end()) {
    values.insert(given->second.begin(), given->second.end());
  }
  const auto host_sync = entry->make(check_parameters(entry->info.parameters, values));
  KeptRecording recording;
  return make_simulation(scenario)->record(
      {.seed = 1, .pipeline = pipeline.name, .host_sync = host_sync.get()}, recording);
}

TEST(GoldenTrace, EveryScenarioDoesWhatItDid) {
  const std::vector<Golden> all = {
      {"18cam_1host_pcie", "free_running", 2497, 0xdc9d33dbeba8a921},
      {"18cam_6host_15fps", "yoon2021_both", 5345, 0x6d2ab7593cb90b01},
      {"18cam_6host_15fps_lan", "yoon2021_both", 6104, 0x87582f844347bee6},
      {"18cam_6host_30fps_studio", "yoon2021_both", 5741, 0xe0bfc6cf7537a789},
      {"18cam_6host_45fps", "yoon2021_both", 5981, 0xba141e482f63fb11},
      {"18cam_6host_45fps_lan", "yoon2021_both", 6668, 0xe48662be14fd3e8f},
      {"18cam_6host_45fps_staggered_start", "yoon2021_both", 4406, 0xdd87a2edfef43804},
      {"18cam_6host_90fps_full_slave", "yoon2021_both", 9116, 0xacf99c7537076e35},
      {"3cam_1host_30fps", "free_running", 285, 0xa2ed9dbbb2c5df47},
      {"6cam_2host_30fps", "yoon2021_both", 1356, 0xe12235e06711401b},
      {"6node_relay", "yoon2021_both", 5505, 0x5a1324fd8ddfcf86},
      {"pulse_index_off_by_two", "yoon2021_both", 6668, 0x3820573813a832c},
      {"scale_18000cam_6000host_45fps", "yoon2021_both", 77848, 0xb8d08ea957b190ae},
      {"18cam_6host_45fps_asymmetric_links", "yoon2021_both", 6668, 0x66b507648f893faa},
      {"18cam_6host_45fps_auto_exposure", "yoon2021_both", 6644, 0xc79ffbaa2aab728},
      {"18cam_6host_45fps_clock_step_during_capture", "yoon2021_both", 6668, 0xe48662be14fd3e8f},
      {"18cam_6host_45fps_frame_drops_10pct", "yoon2021_both", 6439, 0x3bc08717d94f3feb},
      {"18cam_6host_45fps_lan_hardware_clocks", "yoon2021_both", 6668, 0xe48662be14fd3e8f},
      {"18cam_6host_45fps_lan_sdk_toa_1ms", "yoon2021_both", 6668, 0xe48662be14fd3e8f},
      {"18cam_6host_45fps_late_first_frame", "yoon2021_both", 6631, 0xe6a5a42af1354cc4},
      {"18cam_6host_45fps_loaded_network", "yoon2021_both", 6667, 0x8d6519ad208d06d0},
      {"18cam_6host_45fps_loss_and_reordering", "yoon2021_both", 6671, 0xe967a99563b5d6cd},
      {"18cam_6host_45fps_unequal_delays", "yoon2021_both", 6740, 0x6466edf8b0eb0ec7},
      {"18cam_6host_45fps_unequal_phases", "yoon2021_both", 6691, 0x7c6c88d0b2e85992},
      {"18cam_6host_45fps_wander_and_ramp", "yoon2021_both", 6668, 0x77761960d46be9aa},
      {"18cam_6host_45fps_windows_tick", "yoon2021_both", 6668, 0xe48662be14fd3e8f},
      {"18cam_6host_45fps_wrong_t_int", "yoon2021_both", 6632, 0x87ac5485b29d6305},
      {"9cam_3host_30fps_azure_kinect", "yoon2021_both", 3316, 0x15c46ed8edd042e3},
      {"18cam_6host_45fps", "ntp_w32time", 2979, 0x640c0eb1ae8959be},
  };
  for (const scenarios::BuiltinScenario& builtin : scenarios::builtin_scenarios()) {
    // Leaderboards are other tables of the same worlds.
    if (builtin.name.starts_with("leaderboard_")) continue;
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Golden& golden) {
      return golden.scenario == builtin.name;
    })) << builtin.name;
  }
  for (const Golden& golden : all) {
    const RecordingCost cost = run(golden);
    EXPECT_TRUE(cost.events == golden.events && cost.trace_hash == golden.trace_hash)
        << "scenario " << golden.scenario << ", pipeline " << golden.pipeline
        << ", seed 1 now gives\n    {\"" << golden.scenario << "\", \"" << golden.pipeline << "\", "
        << cost.events << ", 0x" << std::hex << cost.trace_hash << "},";
  }
}

}  // namespace
}  // namespace simbench::sim
