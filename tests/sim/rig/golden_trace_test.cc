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
      {"18cam_1host_pcie", "free_running", 2497, 0xa5e2c6aa258a147d},
      {"18cam_6host_15fps", "yoon2021_both", 5345, 0x6cef005d8c8c9220},
      {"18cam_6host_15fps_lan", "yoon2021_both", 6104, 0xe2a34526b18ce6bb},
      {"18cam_6host_30fps_studio", "yoon2021_both", 5741, 0x6afc8607cdda81cc},
      {"18cam_6host_45fps", "yoon2021_both", 5981, 0xfe36769a51076014},
      {"18cam_6host_45fps_lan", "yoon2021_both", 6668, 0xea8bba6513d9ecfe},
      {"18cam_6host_45fps_staggered_start", "yoon2021_both", 4406, 0xb91756324353fe59},
      {"18cam_6host_90fps_full_slave", "yoon2021_both", 9116, 0x6377f1b1d0d25795},
      {"3cam_1host_30fps", "free_running", 285, 0xde38689be5f6844d},
      {"6cam_2host_30fps", "yoon2021_both", 1356, 0x506639a0bc9baeb1},
      {"6host_lan_day", "chrony", 23396, 0xc9781f7845a43044},
      {"6host_star", "chrony", 3978, 0x28a82b00ca163c81},
      {"6node_relay", "yoon2021_both", 5505, 0xf91ed55a486c02a9},
      {"pulse_index_off_by_two", "yoon2021_both", 6668, 0x750fa152f1cf685e},
      {"scale_18000cam_6000host_45fps", "yoon2021_both", 77848, 0x8f4296d0b4f6785f},
      {"18cam_6host_45fps_asymmetric_links", "yoon2021_both", 6668, 0x72c81404ae122ecd},
      {"18cam_6host_45fps_auto_exposure", "yoon2021_both", 6644, 0x425a8103d540fb69},
      {"18cam_6host_45fps_clock_step_during_capture", "yoon2021_both", 6669, 0x687e82265ae81222},
      {"18cam_6host_45fps_frame_drops_10pct", "yoon2021_both", 6439, 0xf6d061a47a7c7c5f},
      {"18cam_6host_45fps_lan_hardware_clocks", "ptp_hardware", 16484, 0x8c09a944cca79df},
      {"18cam_6host_45fps_lan_sdk_toa_1ms", "yoon2021_both", 6668, 0xa24034ad893e72cb},
      {"18cam_6host_45fps_late_first_frame", "yoon2021_both", 6631, 0x3733186b49cb2b2b},
      {"18cam_6host_45fps_loaded_network", "yoon2021_both", 6667, 0xbcc677dcb5f2d404},
      {"18cam_6host_45fps_loss_and_reordering", "yoon2021_both", 6671, 0xf49e613e2814149e},
      {"18cam_6host_45fps_unequal_delays", "yoon2021_both", 6740, 0xd82cf70cfa36c3c1},
      {"18cam_6host_45fps_unequal_phases", "yoon2021_both", 6691, 0x4c35f5036c0a369f},
      {"18cam_6host_45fps_wander_and_ramp", "yoon2021_both", 6668, 0xa951845da456cfda},
      {"18cam_6host_45fps_windows_tick", "yoon2021_both", 6668, 0xcb72f0586cbff845},
      {"18cam_6host_45fps_wrong_t_int", "yoon2021_both", 6632, 0xe7f1c3bdd121e404},
      {"9cam_3host_30fps_azure_kinect", "yoon2021_both", 3316, 0xd6d890326cc3e317},
      {"leaderboard_calibrated", "yoon2021_both", 6165, 0xaaa1a71949e56a87},
      {"leaderboard_gathering", "yoon2021_both", 6617, 0x46aaae700ca8492c},
      {"leaderboard_lan", "host.ptp_e2e_hardware", 16484, 0x9d48faac50b47ae0},
      {"18cam_6host_45fps", "ntp_w32time", 2979, 0x24e609c92d9e7e45},
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
