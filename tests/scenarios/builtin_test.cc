// The scenarios of the distribution, their warnings and descriptions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scenarios/builtin_files.h"
#include "tests/nonempty.h"
#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(Builtin, AllAreThereInOrder) {
  std::vector<std::string> names;
  for (const BuiltinScenario& scenario : builtin_scenarios()) names.push_back(scenario.name);
  EXPECT_THAT(
      names,
      ElementsAre(
          "18cam_1host_pcie", "18cam_6host_15fps", "18cam_6host_15fps_lan",
          "18cam_6host_30fps_studio", "18cam_6host_30fps_without_trigger", "18cam_6host_45fps",
          "18cam_6host_45fps_asymmetric_links", "18cam_6host_45fps_auto_exposure",
          "18cam_6host_45fps_clock_step_during_capture", "18cam_6host_45fps_frame_drops_10pct",
          "18cam_6host_45fps_lan", "18cam_6host_45fps_lan_hardware_clocks",
          "18cam_6host_45fps_lan_sdk_toa_1ms", "18cam_6host_45fps_late_first_frame",
          "18cam_6host_45fps_loaded_network", "18cam_6host_45fps_loss_and_reordering",
          "18cam_6host_45fps_staggered_start", "18cam_6host_45fps_unequal_delays",
          "18cam_6host_45fps_unequal_phases", "18cam_6host_45fps_wander_and_ramp",
          "18cam_6host_45fps_windows_tick", "18cam_6host_45fps_wrong_t_int",
          "18cam_6host_90fps_coded", "18cam_6host_90fps_full_slave", "25cam_led_30fps",
          "2glasses_wifi_30fps", "3cam_1host_30fps", "3host_ptp_switch", "3host_ptp_switch_idle",
          "3host_ptp_switch_receive", "3host_ptp_switch_send", "4cam_wifi_ftm_10fps", "4host_chain",
          "4host_chain_cpu", "4host_chain_idle", "4host_chain_tcp", "4host_gptp_chain",
          "4oak_poe_30fps", "5phone_wifi_30fps", "6cam_2host_30fps", "6cam_basler_flir_ptp_30fps",
          "6cam_gige_ptp_60fps", "6cam_mixed_models_30fps", "6cam_mixed_rates_60fps",
          "6host_lan_day", "6host_star", "6node_relay", "8cam_raspberry_30fps",
          "8cam_raspberry_hq_30fps", "9cam_3host_30fps_azure_kinect", "leaderboard_calibrated",
          "leaderboard_gathering", "leaderboard_lan", "leaderboard_lan_cpu",
          "leaderboard_lan_far_host", "leaderboard_lan_ideal_calibration", "leaderboard_lan_paced",
          "leaderboard_lan_random", "leaderboard_lan_tcp", "leaderboard_programs",
          "leaderboard_without_cables", "pulse_index_off_by_two", "scale_18000cam_6000host_45fps"));
}

TEST(Builtin, AllLoadWithoutWarnings) {
  for (const BuiltinScenario& builtin : nonempty(builtin_scenarios())) {
    SCOPED_TRACE(builtin.name);
    const Scenario scenario = load_scenario(builtin.name);
    EXPECT_EQ(scenario.name, builtin.name);
    EXPECT_EQ(scenario.summary, builtin.summary);
    // The paper's cameras get controls that they do not have, and the summaries say so.
    const bool is_hypothetical = builtin.name == "18cam_6host_30fps_without_trigger" ||
                                 builtin.name == "leaderboard_without_cables";
    EXPECT_THAT(warnings(scenario), Each(HasSubstr("a hypothetical control")));
    EXPECT_EQ(warnings(scenario).size(), is_hypothetical ? 4U : 0U);
    const bool says_what_it_is = scenario.summary.find("fit") != std::string::npos ||
                                 scenario.summary.find("ominal") != std::string::npos;
    EXPECT_TRUE(says_what_it_is) << scenario.summary;
  }
}

// As files of a user's, whose every line is checked.
TEST(Builtin, AllAreValid) {
  for (const BuiltinFile& file : nonempty(builtin_files())) {
    EXPECT_EQ(error_of_text(std::string(file.text)), "") << file.name;
  }
}

TEST(Builtin, ResolvedJsonLoadsAsTheSameScenario) {
  for (const BuiltinScenario& builtin : nonempty(builtin_scenarios())) {
    const std::string once = load_scenario(builtin.name).resolved_json();
    const std::string twice = load_scenario_text(once, "resolved.json").resolved_json();
    EXPECT_EQ(once, twice) << builtin.name;
  }
}

// The two calibrated scenarios by the figures of the fit.
TEST(Builtin, CalibratedWorlds) {
  for (const auto& [name, rate, period_ms, transfer_ms] :
       {std::tuple("18cam_6host_45fps", 45.0, 15.0, 2.33),
        std::tuple("18cam_6host_15fps", 15.0, 0.0, 5.27)}) {
    const Scenario s = load_scenario(name);
    EXPECT_EQ(s.trigger.rate_hz, rate);
    EXPECT_EQ(s.cameras.streams[0].mode_rate_hz, 2 * rate);
    EXPECT_EQ(s.hosts.clock.last_set.minutes_since_baseline, period_ms);
    const Stream& stream = s.cameras.streams[0];
    const double bytes = static_cast<double>(stream.width * stream.height) * stream.bytes_per_pixel;
    EXPECT_NEAR(bytes / s.usb.bandwidth_mb_per_s * 1e-3, transfer_ms, 0.005);
    EXPECT_EQ(s.hosts.clock.set_cost_ms, 4.5);
    EXPECT_EQ(s.cameras.exposure_host_periods, 0.14);
    EXPECT_EQ(s.published.size(), 4U);
    EXPECT_EQ(std::get<double>(s.algorithms.at("yoon2021").at("threshold_ms")), 100);
  }
  EXPECT_EQ(load_scenario("18cam_6host_15fps").published.at("yoon2021_network").amd_ms, 11.1648);
  EXPECT_EQ(load_scenario("18cam_6host_45fps").published.at("yoon2021_network").amd_ms, 3.9161);
}

TEST(Builtin, PipelinesOfTheMainScenario) {
  std::vector<std::string> names;
  for (const Pipeline& pipeline : load_scenario("18cam_6host_45fps").pipelines) {
    names.push_back(pipeline.name);
  }
  EXPECT_THAT(
      names, ElementsAre("ntp_last_set", "ntp_w32time", "yoon2021_network", "yoon2021_time",
                         "yoon2021_both", "yoon2021_neither", "free_running", "oracle", "genlock"));
}

// 848 x 480 x 2 bytes are 73.3 MB/s at the 90 Hz of their mode, half of that at 45 Hz.
TEST(Warnings, MoreBytesThanUsbCarries) {
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_45fps", {{"/usb/bandwidth_mb_per_s", "50"}})),
      ElementsAre("--set /usb/bandwidth_mb_per_s=50: 1 camera on a controller needs 73.3 MB/s "
                  "while the frames of a pulse are read out (the rates of their modes; 36.6 MB/s "
                  "on average), and it carries 50: expect at least 31.8 % of these frames to "
                  "arrive incomplete, which the SDK discards (/usb/hold_mode_periods)"));
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_45fps_lan", {{"/usb/bandwidth_mb_per_s", "100"},
                                                       {"/usb/hold_mode_periods", "0"}})),
      ElementsAre("--set /usb/bandwidth_mb_per_s=100: 3 cameras on a controller need 109.9 MB/s, "
                  "and it carries 100: expect at least 9.0 % of the frames to be lost"));
}

TEST(Warnings, ManyCamerasOnAController) {
  const auto with = [](const char* cameras) {
    return warnings(load_scenario("18cam_1host_pcie", {{"/usb/cameras_per_controller", cameras}}));
  };
  EXPECT_THAT(with("3"), IsEmpty());
  EXPECT_THAT(with("4"),
              ElementsAre("--set /usb/cameras_per_controller=4: 4 cameras on a controller need "
                          "293.1 MB/s of the 400 that it carries, so none is lost on it here; real "
                          "controllers with more than 3 are reported to lose some "
                          "(docs/reference/d455.md section 3)"));
  EXPECT_THAT(with("6"), ElementsAre(HasSubstr("6 cameras on a controller need 439.6 MB/s while")));
  EXPECT_THAT(with("6"), ElementsAre(HasSubstr("expect at least 9.0 % of these frames")));
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_45fps_lan", {{"/usb/cameras_per_controller", "6"}})),
      IsEmpty());
}

TEST(Warnings, CamerasWithABusOfTheirOwnShareNoController) {
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_45fps", {{"/usb/cameras_per_controller", "6"}})),
      ElementsAre("--set /usb/cameras_per_controller=6: each camera has 350 MB/s of its own "
                  "(/usb/sharing is \"dedicated\"), so /usb/cameras_per_controller (found 6, "
                  "allowed 1, which is what that means) changes nothing: \"fair\" and \"fifo\" "
                  "share a controller"));
  // Also as many as there are anyway, and where the sharing is what was changed.
  EXPECT_THAT(warnings(load_scenario("18cam_6host_45fps", {{"/usb/cameras_per_controller", "3"}})),
              ElementsAre(HasSubstr("(found 3, allowed 1")));
  EXPECT_THAT(warnings(load_scenario("18cam_6host_45fps_lan", {{"/usb/sharing", "dedicated"}})),
              ElementsAre(AllOf(HasSubstr("--set /usb/sharing=dedicated: "),
                                HasSubstr("/usb/cameras_per_controller (found 3, allowed 1"))));
  EXPECT_THAT(warnings(load_scenario("18cam_6host_45fps", {{"/usb/cameras_per_controller", "1"}})),
              IsEmpty());
  const Scenario builtin = load_scenario("18cam_6host_45fps");
  EXPECT_THAT(warnings(builtin), IsEmpty());
  EXPECT_THAT(warnings(load_scenario_text(builtin.resolved_json(), "archived.json")), IsEmpty());
  EXPECT_THAT(warnings(load_scenario("18cam_6host_45fps",
                                     {{"/hosts/count", "3"}, {"/cameras/cameras_per_host", "6"}})),
              ElementsAre(HasSubstr("so that 6 cameras are on a host changes nothing")));
}

TEST(Warnings, AReaderThatIsTooSlowOrDecimates) {
  const auto with = [](const char* reader) {
    return warnings(load_scenario("18cam_6host_45fps", {{"/hosts/frame_reader", reader}}));
  };
  EXPECT_THAT(with(R"({"frame_ms": 22, "queue_frames": 4, "full_queue": "drops_oldest"})"),
              IsEmpty());
  EXPECT_THAT(with(R"({"frame_ms": 40, "queue_frames": 4, "full_queue": "drops_oldest"})"),
              ElementsAre(HasSubstr("the program is busy with a frame of depth for 40 ms and gets "
                                    "one each 22.22 ms: 4 wait, then 44.4 % are lost; allowed at "
                                    "most 22.22 ms, or fewer frames/s")));
  EXPECT_THAT(
      with(
          R"({"frame_ms": 1, "queue_frames": 4, "full_queue": "drops_oldest", "passed_every": 2})"),
      ElementsAre(HasSubstr("passes on one frame in 2 by its own count")));
}

TEST(Warnings, PulsesFasterThanTheMode) {
  const auto at = [](const char* rate_hz, const std::vector<Override>& more = {}) {
    std::vector<Override> all = {{"/trigger/rate_hz", rate_hz}};
    all.insert(all.end(), more.begin(), more.end());
    return warnings(load_scenario("18cam_6host_45fps", all));
  };
  EXPECT_THAT(at("45"), IsEmpty());
  EXPECT_THAT(at("90"),
              ElementsAre("--set /trigger/rate_hz=90: genlock in a 90 Hz mode ignores pulses for "
                          "two mode periods less the guard of 0.02, and so follows at most 45.9184 "
                          "Hz: of 90 Hz it answers one pulse in 2, 45 frames/s of depth "
                          "(librealsense #12560)"));
  EXPECT_THAT(at("90", {{"/cameras/common_start", "false"}}),
              ElementsAre(HasSubstr("; cameras that start at different pulses expose at different "
                                    "ones")));
  EXPECT_THAT(at("90.9", {{"/cameras/sync_mode", "slave"}}), IsEmpty());
  EXPECT_THAT(at("45", {{"/cameras/genlock_guard_fraction", "0"}}), IsEmpty());
  EXPECT_THAT(
      at("45", {{"/cameras/genlock_guard_fraction", "0"}, {"/trigger/rate_error_ppm", "1"}}),
      ElementsAre(HasSubstr("follows at most 45 Hz: of 45 Hz it answers one pulse in 2")));
}

TEST(Warnings, ExposureLongerThanThePeriod) {
  EXPECT_THAT(warnings(load_scenario("18cam_6host_45fps_lan", {{"/cameras/exposure_ms", "21.4"}})),
              IsEmpty());
  EXPECT_THAT(warnings(load_scenario("18cam_6host_45fps_lan", {{"/cameras/exposure_ms", "21.5"}})),
              ElementsAre("--set /cameras/exposure_ms=21.5: exposures of up to 21.50 ms, beginning "
                          "0.79 ms after the pulse, do not fit into the frame period of 22.22 ms: "
                          "expect missed pulses and half the rate (realsense-ros #2612)"));
}

TEST(Warnings, AutoExposureAndReadoutLongerThanThePeriod) {
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_45fps_lan",
                             {{"/cameras/auto_exposure/step_interval_exponential_ms", "500"},
                              {"/cameras/auto_exposure/max_ms", "22"}})),
      ElementsAre(StartsWith("--set /cameras/auto_exposure/max_ms=22: exposures of up to "
                             "22.00 ms, beginning 0.79 ms")));
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_45fps_lan", {{"/cameras/streams/0/shutter", "rolling"},
                                                       {"/cameras/streams/0/readout_ms", "14"}})),
      ElementsAre(HasSubstr("exposures of up to 22.00 ms, beginning 0.79 ms"),
                  "--set /cameras/streams/0/shutter=rolling: rolling, but the depth camera "
                  "of the RealSense D455 has a global shutter"));
}

TEST(Warnings, CaptureTrafficAboveTheBandwidth) {
  // 3 * 848 * 480 * 2 bytes at 45 Hz are 879.2 Mbit/s.
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_45fps_lan", {{"/network/capture_traffic_share", "1"}})),
      IsEmpty());
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_45fps_lan", {{"/network/capture_traffic_share", "1"},
                                                       {"/network/bandwidth_mbit_per_s", "800"}})),
      ElementsAre("--set /network/capture_traffic_share=1: the frames of a host are 879 "
                  "Mbit/s on a link that carries 800: what finds more than a second of "
                  "traffic queued is lost"));
}

TEST(Warnings, ScoredFramesThatAreNotTriggered) {
  EXPECT_THAT(
      warnings(load_scenario("18cam_6host_90fps_full_slave",
                             {{"/cameras/sync_mode", "slave"}, {"/evaluation/stream", "colour"}})),
      ElementsAre(StartsWith("--set /evaluation/stream=colour: in sync mode \"slave\" the "
                             "colour stream does not follow the trigger")));
}

TEST(Warnings, EarlyEvaluationAndIdleHosts) {
  EXPECT_THAT(warnings(load_scenario("18cam_6host_45fps_lan",
                                     {{"/timeline/warm_up_ms", "10"}, {"/hosts/count", "8"}})),
              ElementsAre("--set /timeline/warm_up_ms=10: evaluation begins after 10 ms, exposures "
                          "are unsteady for 5000 ms",
                          "--set /hosts/count=8: 2 of 8 hosts have no camera"));
}

TEST(Warnings, ATemperatureThatChangesNothing) {
  EXPECT_THAT(
      warnings(load_scenario("6host_lan_day",
                             {{"/hosts/clock/oscillator/temperature_coefficient_ppb_per_k", "0"}})),
      ElementsAre(HasSubstr("/hosts/temperature: changes nothing")));
}

TEST(Describe, ALineForEveryParameter) {
  const Scenario scenario =
      load_derived(R"("hosts": {"clock": {"tick_ms": 15.6}})", {{"/timeline/frames", "100"}});
  const std::vector<ParameterLine> lines = describe(scenario);
  const auto line = [&lines](const std::string& pointer) {
    const auto found =
        std::find_if(lines.begin(), lines.end(),
                     [&pointer](const ParameterLine& each) { return each.pointer == pointer; });
    return found == lines.end() ? ParameterLine{} : *found;
  };
  EXPECT_EQ(line("/network/latency_fixed_ms").value, "0.1");
  EXPECT_EQ(line("/network/latency_fixed_ms").unit, "ms");
  EXPECT_THAT(line("/network/latency_fixed_ms").meaning,
              HasSubstr("between the cards: fixed part"));
  EXPECT_THAT(line("/network/latency_fixed_ms").source, HasSubstr("FIT-C"));
  EXPECT_EQ(line("/hosts/clock/tick_ms").source, "my.json:3");
  EXPECT_EQ(line("/timeline/frames").source, "--set /timeline/frames=100");
  EXPECT_EQ(line("/hosts/clock/oscillator/random_walk_ppb_per_sqrt_s").unit, "ppb/sqrt(s)");
  EXPECT_EQ(line("/hosts/clock/oscillator/ramp_ppm_per_hour").unit, "ppm/h");
  EXPECT_EQ(line("/hosts/nic/stamp_resolution_ns").unit, "ns");
  EXPECT_EQ(line("/hosts/clock/last_set/hours_ago").unit, "h");
  EXPECT_EQ(line("/usb/bandwidth_mb_per_s").unit, "MB/s");
  EXPECT_EQ(line("/cameras/streams/0/width").unit, "pixels");
  EXPECT_EQ(line("/cameras/host_of_camera").value, "[]");
  EXPECT_EQ(line("/usb/delivery_quantiles_ms").unit, "ms");
  EXPECT_EQ(line("/cameras/skew_of_camera_ppm").unit, "ppm");
  EXPECT_THAT(line("/cameras/model").source, HasSubstr("profile of the RealSense D455"));
  EXPECT_THAT(line("/cameras/streams/0/mode_rate_hz").source, HasSubstr("d455.py"));
  EXPECT_EQ(line("/algorithms/yoon2021/latency_estimate").value, "literal");
  for (const ParameterLine& each : nonempty(lines)) {
    EXPECT_FALSE(each.meaning.empty()) << each.pointer;
    EXPECT_FALSE(each.source.empty()) << each.pointer;
  }
}

TEST(Describe, AMeasuredTableIsOneLine) {
  std::string table = "[0";
  for (int i = 1; i <= 100; ++i) table += "," + std::to_string(i);
  const Scenario scenario = load_derived(R"("usb": {"delivery_quantiles_ms": )" + table + "]}");
  int tables = 0;
  for (const ParameterLine& each : describe(scenario)) {
    EXPECT_FALSE(each.pointer.starts_with("/usb/delivery_quantiles_ms/"));
    if (each.pointer != "/usb/delivery_quantiles_ms") continue;
    EXPECT_EQ(each.value, "[0, ..., 100] (101 numbers)");
    ++tables;
  }
  EXPECT_EQ(tables, 1);
}

}  // namespace
}  // namespace simbench::scenarios
