// What the world does must not change by accident, nor with the compiler, its flags or sanitizers:
// hashes of a short run of every built-in scenario, one over the events of the engine (what
// happened when), one over the recording (every stamp, exchange and true value). Clocks that read
// something else at the same instants change only the recording, another way to compute the same
// world only the events. A change that is meant changes
// these numbers; say why in its commit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "algorithms/ports/host_sync.h"
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
  std::uint64_t trace;
  std::uint64_t recording;
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

// 64-bit FNV-1a.
std::uint64_t recording_hash(const KeptRecording& recording) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const KeptEvent& event : recording.events()) {
    for (const char c : to_line(event) + "\n") {
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
    }
  }
  return hash;
}

// Returns the trace with the numbers that this build gives.
Golden run_golden(const Golden& golden) {
  const scenarios::Scenario scenario =
      scenarios::load_scenario(golden.scenario, brief(golden.scenario));
  const scenarios::Pipeline& pipeline = pipeline_of(scenario, golden.pipeline);
  const HostSyncEntry* entry = find_algorithm<HostSyncEntry>(pipeline.host_sync);
  ParameterValues values;
  if (const auto given = scenario.algorithms.find(entry->info.family);
      given != scenario.algorithms.end()) {
    values.insert(given->second.begin(), given->second.end());
  }
  const auto host_sync = entry->make(check_parameters(entry->info.parameters, values));
  std::unique_ptr<CaptureAlignment> alignment;
  if (const auto* steered = find_algorithm<CaptureAlignmentEntry>(pipeline.capture_alignment)) {
    alignment = steered->make(check_parameters(steered->info.parameters, {}));
  }
  KeptRecording recording;
  const RecordingCost cost =
      make_simulation(scenario)->record({.seed = 1,
                                         .pipeline = pipeline.name,
                                         .host_sync = host_sync.get(),
                                         .capture_alignment = alignment.get()},
                                        recording);
  return {golden.scenario, golden.pipeline, cost.events, cost.trace_hash,
          recording_hash(recording)};
}

// The pipeline is the one that uses most of what is special about the scenario.
const std::vector<Golden>& goldens() {
  static const std::vector<Golden> all = {
      {"18cam_1host_pcie", "free_running", 2269, 0x1a4bb17ea8c3977e, 0x4c3399342368457},
      {"18cam_6host_15fps", "yoon2021_both", 5681, 0x5b013feb93f2d3be, 0xc97e24e4027f7700},
      {"18cam_6host_15fps_lan", "yoon2021_both", 5709, 0x8e87016bbb061575, 0xc4cf9cff288e97af},
      {"18cam_6host_30fps_studio", "yoon2021_both", 5741, 0x982a969b2d98378d, 0x2b5bcb7f2f269c4c},
      {"18cam_6host_45fps", "yoon2021_both", 6497, 0x3177d31c85995c01, 0x135be86619aebced},
      {"18cam_6host_45fps_lan", "yoon2021_both", 6201, 0x56d9dd79e96becf3, 0xc0e51c0f20653787},
      {"18cam_6host_45fps_staggered_start", "yoon2021_both", 4406, 0x8d2a8e71dcd17a65,
       0x7fd6fb93fcd5dd5f},
      {"18cam_6host_90fps_coded", "coded", 2410, 0xe20ea7c952ea35d6, 0x117709101bc1e13c},
      {"18cam_6host_90fps_full_slave", "yoon2021_both", 8543, 0x4ccd0cbf2a66ed27,
       0x8aa78c6927ea637e},
      {"18cam_6host_30fps_without_trigger", "phase_rate", 24745, 0x5f99fae01df4dc87,
       0xebc4edbbfdfd08c4},
      {"4cam_wifi_ftm_10fps", "wifi_ftm", 5338, 0x467416d984f4686b, 0xea9e19f8d6b2a459},
      {"4oak_poe_30fps", "pid_frame_rate", 11870, 0xc307dcc6b519a3d9, 0xb6931be9838e63ca},
      {"5phone_wifi_30fps", "libsoftwaresync", 1990, 0xf83b7a5dabb93417, 0x1c5e89cc9a32e010},
      {"6cam_gige_ptp_60fps", "periodic_ptp", 17074, 0x72551668f222b139, 0x504abda48001c912},
      {"8cam_raspberry_30fps", "rpi_sync", 129717, 0x2512bfdb78d7a74a, 0xa5933819563938ec},
      {"6cam_basler_flir_ptp_30fps", "ptp_stamps", 16863, 0x5fb58b2530e0c176, 0x8d70b3b2249b0272},
      {"6cam_mixed_models_30fps", "best_online", 4401, 0x99a0dbf36a99a92c, 0x20f8432f917479a0},
      {"6cam_mixed_rates_60fps", "best_online", 4418, 0x46e2c8833054e82, 0xa97e2f0abe312e2},
      {"8cam_raspberry_hq_30fps", "rpi_sync", 129717, 0x192fecb3a1beaf38, 0x529c00fc852c87e6},
      {"leaderboard_without_cables", "align.rpi_sync", 24766, 0x6a2b6133b005c375,
       0xf7c9d9051326d7a6},
      {"25cam_led_30fps", "rocsync_led", 1286, 0xf183074e01d63c3d, 0xd3a18f63ae409ba8},
      {"2glasses_wifi_30fps", "ticsync", 16201, 0x4230a956c6b0ef5, 0x9480af2f62adc3ea},
      {"3cam_1host_30fps", "free_running", 355, 0x7621b8b0d8390f02, 0xf6702f4f19a31d6b},
      {"6cam_2host_30fps", "yoon2021_both", 1496, 0x33f20be7b2cbccb, 0xa044034876d7b0b5},
      {"6host_lan_day", "chrony", 22790, 0x8e2ca9f0df261acc, 0x6ae62dc86818a090},
      {"6host_star", "chrony", 3666, 0x953bcf675cb1f737, 0xc96977fddd459e84},
      {"6node_relay", "yoon2021_both", 6019, 0x533fe6ef23843ab7, 0x48db9a1c49cffcba},
      {"pulse_index_off_by_two", "yoon2021_both", 6202, 0x93aa7ebe3c43905c, 0xd7e9b190b80fa028},
      {"scale_18000cam_6000host_45fps", "yoon2021_both", 75610, 0x451360b46c984dd0,
       0xfdc6e3922c64008d},
      {"18cam_6host_45fps_asymmetric_links", "yoon2021_both", 6197, 0xec5ec86fa18c7617,
       0x892361bac0eb9ab0},
      {"18cam_6host_45fps_auto_exposure", "yoon2021_both", 6201, 0xe11f1b5b84966250,
       0x3c964b176d590c91},
      {"18cam_6host_45fps_clock_step_during_capture", "yoon2021_both", 6202, 0x766a3e3e12ac7fe9,
       0xdca5f60f7ac39717},
      {"18cam_6host_45fps_frame_drops_10pct", "yoon2021_both", 6055, 0x49164f815aa2f5b7,
       0xb84a0007c3673ecf},
      {"18cam_6host_45fps_lan_hardware_clocks", "ptp_hardware", 15803, 0x223a62bf80790d37,
       0xbb9de6c09701c615},
      {"18cam_6host_45fps_lan_sdk_toa_1ms", "yoon2021_both", 6201, 0x56d9dd79e96becf3,
       0xf6bb9c42fb0b3012},
      {"18cam_6host_45fps_late_first_frame", "yoon2021_both", 6201, 0x3fa8465dcd3ed766,
       0x8a23002a2eae7e44},
      {"18cam_6host_45fps_loaded_network", "yoon2021_both", 6221, 0xd6b7d4b03b9cae3d,
       0x21907a38166d1f6f},
      {"18cam_6host_45fps_loss_and_reordering", "yoon2021_both", 6147, 0x9775d24fe2b8257c,
       0x1e9a20acbd5231ad},
      {"18cam_6host_45fps_unequal_delays", "yoon2021_both", 6201, 0x93ef6b8e129415cd,
       0x863800aa07896790},
      {"18cam_6host_45fps_unequal_phases", "yoon2021_both", 6201, 0xaaac6187e53e5e11,
       0xd1602d735dd6122a},
      {"18cam_6host_45fps_wander_and_ramp", "yoon2021_both", 6201, 0x850707ed8d4fbfa1,
       0x4fc67f0a247e6a07},
      {"18cam_6host_45fps_windows_tick", "yoon2021_both", 6201, 0x56d9dd79e96becf3,
       0x45cadd3d1ece05e7},
      {"18cam_6host_45fps_wrong_t_int", "yoon2021_both", 6177, 0x572c522d299db205,
       0xefc239ecdaf60b4d},
      {"9cam_3host_30fps_azure_kinect", "yoon2021_both", 3086, 0x8610be22dd06a02,
       0x324d358616d34116},
      {"3host_ptp_switch", "ptp_hw_phc2sys", 6171, 0x3d0f7990e9b6bb8e, 0xe65dd428efdf213f},
      {"3host_ptp_switch_idle", "oracle", 420, 0x64433f35f2e3f44d, 0x168b11f953023b8d},
      {"3host_ptp_switch_receive", "ptp_hw_phc2sys", 6161, 0x85eea50bd4ab1601, 0x669dc8e9872b44c0},
      {"3host_ptp_switch_send", "ptp_hw_phc2sys", 6171, 0xef1fbc8bf310414, 0x624a1bb36b8d08ed},
      {"4host_chain", "chrony_hw_xleave", 27405, 0xd72662579205bcfe, 0x74d41e02200a8048},
      {"4host_chain_cpu", "chrony_sw", 3885, 0xc83095f635ac1d21, 0x7842ec26f7ba6330},
      {"4host_chain_idle", "chrony_sw", 3920, 0x87089f7363522c7d, 0x84265f2ffc65c626},
      {"4host_gptp_chain", "gptp_hardware", 25685, 0xa940bc81baca38c6, 0x12ee88d45a7d347},
      {"leaderboard_lan_cpu", "host.chrony_sw", 7399, 0x5db7a451189ff90, 0x86864f702200abce},
      {"leaderboard_lan_far_host", "host.two_way_hull", 21145, 0x9d2b61fa42e5382f,
       0xbd6f9155fbf5e5c3},
      {"leaderboard_lan_paced", "host.ptp_e2e_software", 37937, 0xa14a9a7042514af3,
       0xd6c17aef0eac46a3},
      {"leaderboard_lan_random", "host.two_way_hull", 21189, 0x20cdbc58f884af6e,
       0x2cd1f28f5602e0e4},
      {"leaderboard_lan_tcp", "host.two_way_hull", 21134, 0xa017c9a5a5961702, 0x51874152fbefd195},
      {"4host_chain_tcp", "chrony_hw_xleave", 27402, 0x8cb712c26dac910e, 0xc1c321dd70664d6b},
      {"leaderboard_calibrated", "yoon2021_both", 6681, 0x45f00caafdd71aa0, 0xa8308ee4bfcc45af},
      {"leaderboard_gathering", "yoon2021_both", 6168, 0xb3a9d2424860cf34, 0x51d2f700b0f49393},
      {"leaderboard_lan", "host.ptp_e2e_hardware", 15803, 0x223a62bf80790d37, 0x5f19e96a8569bf53},
      {"leaderboard_lan_ideal_calibration", "host.ptp_e2e_hardware", 15803, 0xcb24e6ba31c90810,
       0xc5b96ae9cd50c4f1},
      {"leaderboard_programs", "chrony", 9762, 0x6616f7c29c696f70, 0xfa83a6c497dc9b0c},
      {"18cam_6host_45fps", "ntp_w32time", 3495, 0x8232d96d0265fdd2, 0xc6fefeb25269eef6},
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
    EXPECT_TRUE(now.events == golden.events && now.trace == golden.trace &&
                now.recording == golden.recording)
        << "scenario " << golden.scenario << ", pipeline " << golden.pipeline
        << ", seed 1 now gives\n    {\"" << golden.scenario << "\", \"" << golden.pipeline << "\", "
        << now.events << ", 0x" << std::hex << now.trace << ", 0x" << now.recording << "},";
  }
}

// No two of them are the same world: what changes only what is special about one of them changes a
// hash.
TEST(GoldenTrace, EveryWorldHasAHashOfItsOwn) {
  std::map<std::uint64_t, std::string> scenario_of;
  for (const Golden& golden : goldens()) {
    const auto [first, fresh] = scenario_of.emplace(golden.recording, golden.scenario);
    EXPECT_TRUE(fresh) << golden.scenario << " and " << first->second;
  }
}

}  // namespace
}  // namespace simbench::sim
