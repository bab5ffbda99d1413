#include "scenarios/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/nonempty.h"
#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using testing::HasSubstr;

double delay_ms(const std::string& scenario, const std::vector<Override>& overrides = {}) {
  const Scenario loaded = load_scenario(scenario, overrides);
  return calibrated_delay_ms(loaded, *loaded.scored_stream());
}

const std::vector<Override> kNoCommonJitter = {{"/usb/host_jitter_transfers", "0"}};

// Pipeline latency, mode periods, and a transfer at 350 MB/s alone or at 400 among three.
TEST(Calibration, IsWhatTheWorldSays) {
  EXPECT_EQ(delay_ms("18cam_6host_45fps"), 10.33);
  EXPECT_EQ(delay_ms("18cam_6host_15fps"), 13.27);
  EXPECT_EQ(delay_ms("18cam_6host_30fps_studio"), 10.33);
  EXPECT_EQ(delay_ms("3cam_1host_30fps"), 10.33);
  EXPECT_EQ(delay_ms("6cam_2host_30fps"), 10.33);
  EXPECT_EQ(delay_ms("leaderboard_calibrated"), 10.33);
  EXPECT_EQ(delay_ms("18cam_6host_45fps_lan", kNoCommonJitter), 20.11);
  EXPECT_EQ(delay_ms("18cam_6host_15fps_lan", kNoCommonJitter), 39.82);
  EXPECT_EQ(delay_ms("18cam_6host_90fps_full_slave", kNoCommonJitter), 20.91);
  EXPECT_EQ(delay_ms("pulse_index_off_by_two", kNoCommonJitter), 56.11);
  EXPECT_EQ(delay_ms("18cam_6host_45fps_lan_sdk_toa_1ms", kNoCommonJitter), 19.61);
  EXPECT_EQ(delay_ms("18cam_1host_pcie", kNoCommonJitter), 20.11);
}

TEST(Calibration, FollowsTheWorld) {
  const std::string lan = "18cam_6host_45fps_lan";
  const auto with = [&](const std::string& pointer, const std::string& value) {
    return delay_ms(lan, {kNoCommonJitter[0], {pointer, value}});
  };
  // 0.54 periods of 16.67 and 33.33 in place of 11.11 ms.
  EXPECT_NEAR(delay_ms(lan, {kNoCommonJitter[0],
                             {"/trigger/rate_hz", "30"},
                             {"/cameras/streams/0/mode_rate_hz", "60"}}),
              23.11, 0.005);
  EXPECT_NEAR(delay_ms(lan, {kNoCommonJitter[0],
                             {"/trigger/rate_hz", "15"},
                             {"/cameras/streams/0/mode_rate_hz", "30"}}),
              32.11, 0.005);
  // Three transfers of 614,400 in place of 814,080 bytes.
  EXPECT_NEAR(with("/cameras/streams/0/width", "640"), 18.61, 0.005);
  EXPECT_NEAR(with("/usb/bandwidth_mb_per_s", "800"), 17.05, 0.005);
  EXPECT_NEAR(with("/usb/sharing", "dedicated"), 16.03, 0.005);
  EXPECT_NEAR(with("/usb/sharing", "fifo"), 18.07, 0.005);  // one, two or three transfers
  EXPECT_NEAR(with("/usb/cameras_per_controller", "1"), 16.03, 0.005);
  EXPECT_NEAR(with("/usb/delivery_quantiles_ms", "[0.5, 2]"), 20.61, 0.005);
  EXPECT_NEAR(with("/hosts/clock/arrival_quantum_ms", "1"), 19.61, 0.005);
  // The trigger's own rate is in no delay.
  EXPECT_EQ(with("/trigger/rate_hz", "40"), 20.11);
}

// No jitter that is each frame's own, all of a jitter that never changes.
TEST(Calibration, HasTheLevelOfTheCommonJitter) {
  const auto with = [](const std::string& correlation) {
    return delay_ms("18cam_6host_45fps_lan", {{"/usb/host_jitter_transfers", "1"},
                                              {"/usb/host_jitter_correlation", correlation}});
  };
  constexpr double kTransferMs = 2.035;
  EXPECT_NEAR(with("0"), 20.11, 0.005);
  EXPECT_NEAR(with("0.8"), 20.11 + kTransferMs * (1 - 1.0 / 3), 0.01);
  EXPECT_NEAR(with("0.999999"), 20.11 + kTransferMs, 0.01);
}

TEST(Calibration, OfARollingShutterIsThatOfItsMiddleRow) {
  const Scenario kinect = load_scenario("9cam_3host_30fps_azure_kinect", kNoCommonJitter);
  const double depth_ms = calibrated_delay_ms(kinect, kinect.cameras.streams[0]);
  const double colour_ms = calibrated_delay_ms(kinect, kinect.cameras.streams[1]);
  // 26 ms, and three frames of 737,280 and 276,480 bytes; a daisy chain of 0, 0.16, 0.32 ms.
  EXPECT_NEAR(depth_ms, 26 + 7.60 - 0.32, 0.1);
  EXPECT_NEAR(colour_ms, 26 + 16.7 / 2 + 4.15 - 0.32, 0.1);
}

// Fair sharing serves frames sooner that come one after the other.
TEST(Calibration, OfCamerasOfDifferentLatency) {
  const std::vector<Override> spread = {kNoCommonJitter[0],
                                        {"/cameras/latency_camera_max_ms", "1"}};
  // Half of 1 ms later, and twice the distance of the mean from the first of three: 1/4 ms.
  EXPECT_NEAR(delay_ms("18cam_6host_45fps_lan", spread), 20.11 + 0.5 - 0.5, 0.02);
  EXPECT_NEAR(delay_ms("18cam_6host_45fps", spread), 10.33 + 0.5, 0.02);
}

TEST(Calibration, OfAFreeRunningStreamIsAlone) {
  const Scenario slaves = load_scenario("18cam_6host_90fps_full_slave",
                                        {kNoCommonJitter[0], {"/cameras/sync_mode", "slave"}});
  // In slave mode depth follows the trigger and colour does not.
  EXPECT_NEAR(calibrated_delay_ms(slaves, slaves.cameras.streams[0]), 14 + 3 * 1.152, 0.005);
  EXPECT_NEAR(calibrated_delay_ms(slaves, slaves.cameras.streams[1]), 14 + 1.152, 0.005);
}

TEST(Calibration, OfPollsIsTheDifferenceOfTheirDelays) {
  EXPECT_EQ(calibrated_asymmetry_ms(load_scenario("18cam_6host_45fps").cameras.clock_poll), 0.2);
  const Scenario other =
      load_scenario("18cam_6host_45fps_lan", {{"/cameras/clock_poll/reply_ms", "0.7"}});
  EXPECT_NEAR(calibrated_asymmetry_ms(other.cameras.clock_poll), -0.3, 1e-12);
}

constexpr const char* kStream = R"("cameras": {"streams": [
  {"kind": "depth", "width": 848, "height": 480, "bytes_per_pixel": 2, "mode_rate_hz": 90,
   "pipeline_latency_ms": 8, "latency_mode_periods": 0, "shutter": "global", "readout_ms": 0,
   )";

std::string stream_with(const std::string& members) { return kStream + members + "}]}"; }

TEST(Calibration, StatedOnesHoldWhereTheyWereMeasured) {
  const std::string stated = stream_with(R"("calibrated_delay_ms": 12.5,
   "calibrated_at": {"width": 848, "height": 480, "mode_rate_hz": 90})");
  const Scenario scenario = load_derived(stated);
  EXPECT_EQ(calibrated_delay_ms(scenario, *scenario.scored_stream()), 12.5);

  const auto error_with = [&](const std::vector<Override>& overrides) {
    return error_of_text(derived(stated), overrides);
  };
  EXPECT_EQ(error_with({{"/trigger/rate_hz", "30"}}), "") << "the mode is the same";
  EXPECT_EQ(error_with({{"/trigger/rate_hz", "30"}, {"/cameras/streams/0/mode_rate_hz", "60"}}),
            "my.json:7: /cameras/streams/0/calibrated_at/mode_rate_hz: found 90, allowed 60, "
            "/cameras/streams/0/mode_rate_hz: a calibration holds where it was measured; null in "
            "its place is computed for this world");
  EXPECT_THAT(
      error_with({{"/cameras/streams/0/width", "640"}}),
      HasSubstr("my.json:7: /cameras/streams/0/calibrated_at/width: found 848, allowed 640"));
  EXPECT_THAT(error_with({{"/cameras/streams/0/width", "640"},
                          {"/cameras/streams/0/height", "360"},
                          {"/cameras/streams/0/calibrated_at/width", "640"}}),
              HasSubstr("/cameras/streams/0/calibrated_at/height: found 480, allowed 360"));
  // Forgotten, they are computed.
  const std::vector<Override> forgotten = {{"/trigger/rate_hz", "30"},
                                           {"/cameras/streams/0/mode_rate_hz", "60"},
                                           {"/cameras/streams/0/calibrated_delay_ms", "null"},
                                           {"/cameras/streams/0/calibrated_at", "null"}};
  const Scenario computed = load_derived(stated, forgotten);
  EXPECT_EQ(calibrated_delay_ms(computed, *computed.scored_stream()), 10.33);
}

TEST(Calibration, StatedOnesOfPollsToo) {
  const std::string stated = R"("cameras": {"clock_poll": {"calibrated_asymmetry_ms": 0.25,
   "calibrated_at": {"request_ms": 0.4, "reply_ms": 0.2}}})";
  EXPECT_EQ(calibrated_asymmetry_ms(load_derived(stated).cameras.clock_poll), 0.25);
  EXPECT_EQ(error_of_text(derived(stated), {{"/cameras/clock_poll/reply_ms", "0.1"}}),
            "my.json:4: /cameras/clock_poll/calibrated_at/reply_ms: found 0.2, allowed 0.1, "
            "/cameras/clock_poll/reply_ms: a calibration holds where it was measured; null in its "
            "place is computed for this world");
}

TEST(Calibration, AValueAndItsPlaceBelongTogether) {
  EXPECT_EQ(error_of(stream_with(R"("calibrated_delay_ms": 12.5)")),
            "my.json:6: /cameras/streams/0/calibrated_delay_ms: found no calibrated_at beside it, "
            "allowed both (a calibration holds where it was measured) or neither (it is computed "
            "for this world)");
  EXPECT_THAT(
      error_of(
          stream_with(R"("calibrated_at": {"width": 848, "height": 480, "mode_rate_hz": 90})")),
      HasSubstr("/cameras/streams/0/calibrated_at: found no calibrated_delay_ms beside it"));
  EXPECT_THAT(error_of(R"("cameras": {"clock_poll": {"calibrated_asymmetry_ms": 0.2}})"),
              HasSubstr("/cameras/clock_poll/calibrated_asymmetry_ms: found no calibrated_at"));
  EXPECT_THAT(
      error_of(stream_with(R"("calibrated_delay_ms": 12.5, "calibrated_at": {"width": 848})")),
      HasSubstr("/cameras/streams/0/calibrated_at/height: found nothing"));
}

TEST(Calibration, IsDescribedWhereItIsComputed) {
  std::vector<std::pair<std::string, std::string>> described;
  for (const ParameterLine& line : nonempty(describe(load_scenario("18cam_6host_45fps")))) {
    if (line.pointer.find("calibrated") == std::string::npos) continue;
    described.emplace_back(line.pointer, line.value + ' ' + line.unit);
    EXPECT_EQ(line.source, "computed for this world (scenarios/calibration.h)");
  }
  EXPECT_EQ(described, (std::vector<std::pair<std::string, std::string>>{
                           {"/cameras/streams/0/calibrated_delay_ms", "10.33 ms"},
                           {"/cameras/clock_poll/calibrated_asymmetry_ms", "0.2 ms"}}));
}

TEST(Calibration, FittedWorldsHaveNoErrors) {
  for (const BuiltinScenario& builtin : nonempty(builtin_scenarios())) {
    const Scenario scenario = load_scenario(builtin.name);
    const CalibrationError& error = scenario.cameras.calibration;
    const bool is_lan = scenario.usb.sharing == UsbSharing::kFair;
    const bool is_real = is_lan && !builtin.name.ends_with("_ideal_calibration");
    EXPECT_EQ(error.delay_error_sigma_ms, is_real ? 0.05 : 0) << builtin.name;
    EXPECT_EQ(error.camera_delay_error_sigma_ms, is_real ? 0.1 : 0) << builtin.name;
    EXPECT_EQ(error.poll_asymmetry_error_sigma_ms, is_real ? 0.1 : 0) << builtin.name;
    EXPECT_EQ(scenario.usb.spike_probability > 0, is_lan) << builtin.name;
    EXPECT_EQ(scenario.usb.host_jitter_transfers > 0, is_lan) << builtin.name;
  }
}

}  // namespace
}  // namespace simbench::scenarios
