// What the world does must not change by accident, nor with the compiler, its flags or sanitizers:
// a hash of a short run of every built-in scenario, over the events of the engine (what
// happened when) and over the recording (every stamp, exchange and true value). Clocks that read
// something else at the same instants change only the recording. A change that is meant changes
// these numbers; say why in its commit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "algorithms/registry.h"
#include "recording/event.h"
#include "recording/event_text.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::sim {
namespace {

struct Golden {
  std::string scenario;
  std::string pipeline;
  std::uint64_t events;
  std::uint64_t hash;
};

// A tenth of the scale scenario is enough of it.
std::vector<scenarios::Override> brief(const std::string& scenario) {
  std::vector<scenarios::Override> overrides = {{"/timeline/frames", "20"},
                                                {"/timeline/warm_up_ms", "500"}};
  if (scenario.starts_with("scale_")) {
    overrides.push_back({"/hosts/count", "60"});
    overrides.push_back({"/cameras/count", "180"});
  }
  // Its first step would come long after the last frame.
  if (scenario.ends_with("_clock_step_during_capture")) {
    overrides.push_back({"/faults/0/at_ms", "700"});
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

// 64-bit FNV-1a, begun with the trace hash.
std::uint64_t trace_hash(const RecordingCost& cost, const KeptRecording& recording) {
  std::uint64_t hash = cost.trace_hash;
  for (const RecordingEvent& event : recording.events()) {
    for (const char c : to_line(event) + "\n") {
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    }
  }
  return hash;
}

// The same with the numbers that this build gives.
Golden run_golden(const Golden& golden) {
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
  const RecordingCost cost = make_simulation(scenario)->record(
      {.seed = 1, .pipeline = pipeline.name, .host_sync = host_sync.get()}, recording);
  return {golden.scenario, golden.pipeline, cost.events, trace_hash(cost, recording)};
}

// The pipeline is the one that uses most of what is special about the scenario.
const std::vector<Golden>& goldens() {
  static const std::vector<Golden> all = {
      {"18cam_1host_pcie", "free_running", 2497, 0xb06cac447aadd03},
      {"18cam_6host_15fps", "yoon2021_both", 5345, 0xe7c8491eea8ba2cb},
      {"18cam_6host_15fps_lan", "yoon2021_both", 5865, 0xb8f1054a04629b17},
      {"18cam_6host_30fps_studio", "yoon2021_both", 5741, 0x26f9f0216b648eb3},
      {"18cam_6host_45fps", "yoon2021_both", 5981, 0x9475f5783ef61225},
      {"18cam_6host_45fps_lan", "yoon2021_both", 6429, 0x4346ad78c96d49be},
      {"18cam_6host_45fps_staggered_start", "yoon2021_both", 4406, 0x3f1f6dfef0460e74},
      {"18cam_6host_90fps_full_slave", "yoon2021_both", 8877, 0x3be74ea05b030df2},
      {"3cam_1host_30fps", "free_running", 285, 0x8e527a6a0ee8648d},
      {"6cam_2host_30fps", "yoon2021_both", 1356, 0x7282abaa159ce144},
      {"6host_lan_day", "chrony", 23018, 0xc57f2b29d55312ef},
      {"6host_star", "chrony", 3894, 0xafc1f7f89ecb9025},
      {"6node_relay", "yoon2021_both", 5503, 0xaeb035539d0773ed},
      {"pulse_index_off_by_two", "yoon2021_both", 6429, 0x4c6731ae80a67743},
      {"scale_18000cam_6000host_45fps", "yoon2021_both", 77890, 0x275353628c16302f},
      {"18cam_6host_45fps_asymmetric_links", "yoon2021_both", 6425, 0x1572591468d6fd4b},
      {"18cam_6host_45fps_auto_exposure", "yoon2021_both", 6405, 0x2b994157612b5c8f},
      {"18cam_6host_45fps_clock_step_during_capture", "yoon2021_both", 6430, 0xe51d84024144a782},
      {"18cam_6host_45fps_frame_drops_10pct", "yoon2021_both", 6200, 0x1befbe5e7e1d55a2},
      {"18cam_6host_45fps_lan_hardware_clocks", "ptp_hardware", 16031, 0x4221d3ca0ea0f2c7},
      {"18cam_6host_45fps_lan_sdk_toa_1ms", "yoon2021_both", 6429, 0xc6a9db67f6e6e48f},
      {"18cam_6host_45fps_late_first_frame", "yoon2021_both", 6392, 0xccb91becb6e58e96},
      {"18cam_6host_45fps_loaded_network", "yoon2021_both", 6449, 0x53f89701da0a4936},
      {"18cam_6host_45fps_loss_and_reordering", "yoon2021_both", 6375, 0x5efbfba88c914616},
      {"18cam_6host_45fps_unequal_delays", "yoon2021_both", 6501, 0xaf2bc0073a902c1d},
      {"18cam_6host_45fps_unequal_phases", "yoon2021_both", 6452, 0xc009ee33a51e7348},
      {"18cam_6host_45fps_wander_and_ramp", "yoon2021_both", 6429, 0xc16f1c319c2b82c2},
      {"18cam_6host_45fps_windows_tick", "yoon2021_both", 6429, 0xde11abde6b921ec2},
      {"18cam_6host_45fps_wrong_t_int", "yoon2021_both", 6393, 0x951bc4f7b77c6f12},
      {"9cam_3host_30fps_azure_kinect", "yoon2021_both", 3248, 0x434753453d2cd21c},
      {"leaderboard_calibrated", "yoon2021_both", 6165, 0xf205d7c2a8cfafbe},
      {"leaderboard_gathering", "yoon2021_both", 6378, 0xa9b2627da3731dfe},
      {"leaderboard_lan", "host.ptp_e2e_hardware", 16031, 0x71ac7cd8459ee96d},
      {"leaderboard_lan_ideal_calibration", "host.ptp_e2e_hardware", 16031, 0x16565f708c6cb348},
      {"leaderboard_programs", "chrony", 9990, 0x59b990f54fb0fcb5},
      {"18cam_6host_45fps", "ntp_w32time", 2979, 0x6854e19e118c9bd3},
  };
  return all;
}

TEST(GoldenTrace, EveryScenarioDoesWhatItDid) {
  for (const scenarios::BuiltinScenario& builtin : scenarios::builtin_scenarios()) {
    EXPECT_TRUE(std::any_of(goldens().begin(), goldens().end(), [&](const Golden& golden) {
      return golden.scenario == builtin.name;
    })) << builtin.name;
  }
  for (const Golden& golden : goldens()) {
    const Golden now = run_golden(golden);
    EXPECT_TRUE(now.events == golden.events && now.hash == golden.hash)
        << "scenario " << golden.scenario << ", pipeline " << golden.pipeline
        << ", seed 1 now gives\n    {\"" << golden.scenario << "\", \"" << golden.pipeline << "\", "
        << now.events << ", 0x" << std::hex << now.hash << "},";
  }
}

// No two of them are the same world: what changes only what is special about one of them changes a
// hash.
TEST(GoldenTrace, EveryWorldHasAHashOfItsOwn) {
  std::map<std::uint64_t, std::string> scenario_of;
  for (const Golden& golden : goldens()) {
    const auto [first, fresh] = scenario_of.emplace(golden.hash, golden.scenario);
    EXPECT_TRUE(fresh) << golden.scenario << " and " << first->second;
  }
}

}  // namespace
}  // namespace simbench::sim
