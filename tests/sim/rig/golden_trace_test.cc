// What the world does, event by event, must not change by accident, nor with the compiler, its
// flags or sanitizers: the trace hash of a short run of every built-in scenario. A change that is
// meant changes these numbers; say why in its commit.
#include <gtest/gtest.h>

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
      {"18cam_1host_pcie", "free_running", 2323, 0x9c03630b3cc30c80},
      {"18cam_6host_15fps", "yoon2021_both", 5345, 0x15a10e44a2c9772c},
      {"18cam_6host_15fps_lan", "yoon2021_both", 5762, 0xa243d56c7c37a9c7},
      {"18cam_6host_45fps", "yoon2021_both", 5981, 0x191f330ea55c0c94},
      {"18cam_6host_45fps_lan", "yoon2021_both", 6494, 0xdbe6cf3dc6c78ea9},
      {"18cam_6host_45fps_staggered_start", "yoon2021_both", 4406, 0x66c43328706f0ed2},
      {"18cam_6host_90fps_full_slave", "yoon2021_both", 9038, 0xe64282880b512843},
      {"3cam_1host_30fps", "free_running", 285, 0xa2ed9dbbb2c5df47},
      {"6cam_2host_30fps", "yoon2021_both", 1356, 0xe4c8f92d93c1aab7},
      {"pulse_index_off_by_two", "yoon2021_both", 6494, 0x9a0d1563058d1cd2},
      {"scale_18000cam_6000host_45fps", "yoon2021_both", 77848, 0xb8d08ea957b190ae},
      {"18cam_6host_45fps", "ntp_w32time", 2979, 0xb5e8836b246d26a8},
  };
  EXPECT_GE(all.size(), scenarios::builtin_scenarios().size());
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
