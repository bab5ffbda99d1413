// Checks and warnings of cameras that a capture_alignment steers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Loading a built-in scenario with that set fails with this message; "" if it does not.
std::string refusal_of_set(const std::string& scenario, const std::vector<Override>& overrides) {
  try {
    load_scenario(scenario, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string refusal_by_pi(const std::string& pointer, const std::string& value) {
  return refusal_of_set("8cam_raspberry_30fps", {{pointer, value}});
}

TEST(FrameControl, IsOfOneStream) {
  EXPECT_THAT(
      refusal_of_set("8cam_raspberry_30fps",
                     {{"/cameras/model", "d455"},
                      {"/cameras/streams",
                       R"([{"kind": "depth", "width": 848, "height": 480, "bytes_per_pixel": 2,
                     "mode_rate_hz": 30, "pipeline_latency_ms": 8, "latency_mode_periods": 0,
                     "shutter": "global", "readout_ms": 0},
                    {"kind": "colour", "width": 848, "height": 480, "bytes_per_pixel": 2,
                     "mode_rate_hz": 30, "pipeline_latency_ms": 8, "latency_mode_periods": 0,
                     "shutter": "global", "readout_ms": 0}])"}}),
      AllOf(HasSubstr("/cameras/streams"),
            HasSubstr("found 2 streams, allowed 1 with /cameras/frame_control")));
}

TEST(FrameControl, LengthsAreInOrder) {
  EXPECT_EQ(refusal_by_pi("/cameras/frame_control/granularity_us", "17851"),
            "--set /cameras/frame_control/granularity_us=17851: found 17851, allowed at most the "
            "shortest frame, 17.85 ms (/cameras/frame_control/shortest_ms)");
  EXPECT_EQ(refusal_by_pi("/cameras/frame_control/shortest_ms", "876"),
            "--set /cameras/frame_control/shortest_ms=876: found 876, allowed at most "
            "/cameras/frame_control/longest_ms, 875");
}

TEST(FrameControl, TheRateIsWithinTheLengths) {
  EXPECT_THAT(refusal_by_pi("/cameras/frame_control/shortest_ms", "33.4"),
              HasSubstr("/trigger/rate_hz: found 30, a grid that the cameras' rate cannot reach"));
  EXPECT_THAT(refusal_by_pi("/cameras/frame_control/longest_ms", "33.3"),
              HasSubstr("/trigger/rate_hz: found 30, a grid that the cameras' rate cannot reach: "
                        "frames of 33.3333 ms, allowed 17.85 to 33.3 ms"));
  EXPECT_EQ(refusal_by_pi("/cameras/frame_control/longest_ms", "33.4"), "");
}

TEST(FrameControl, ExposureAndAGranuleFitIntoAFrame) {
  // 33.3333 ms less 13.36 us.
  EXPECT_EQ(refusal_by_pi("/cameras/exposure_ms", "33.31"), "");
  EXPECT_EQ(refusal_by_pi("/cameras/exposure_ms", "33.33"),
            "--set /cameras/exposure_ms=33.33: found exposures of up to 33.33 ms, allowed at most "
            "33.32 ms: a frame of 33.3333 ms less a granule of "
            "/cameras/frame_control/granularity_us");
  EXPECT_THAT(refusal_by_pi("/cameras/exposure_host_periods", "0.8"),
              HasSubstr("/cameras/exposure_ms: found exposures of up to 34.6667 ms"));
  EXPECT_THAT(refusal_by_pi("/cameras/exposure_camera_periods", "0.8"),
              HasSubstr("found exposures of up to 34.6667 ms"));
  EXPECT_THAT(refusal_of_set("8cam_raspberry_30fps",
                             {{"/cameras/auto_exposure/step_interval_exponential_ms", "500"},
                              {"/cameras/auto_exposure/max_ms", "34"}}),
              HasSubstr("--set /cameras/auto_exposure/max_ms=34: found exposures of up to 34 ms"));
}

TEST(FrameControl, TheReadoutIsNoLongerThanAFrame) {
  EXPECT_EQ(refusal_by_pi("/cameras/streams/0/readout_ms", "33.3"), "");
  EXPECT_EQ(refusal_by_pi("/cameras/streams/0/readout_ms", "33.4"),
            "--set /cameras/streams/0/readout_ms=33.4: found 33.4, allowed at most the length of a "
            "frame, 33.3333 ms: the next one's readout begins then");
}

TEST(FrameControl, ACameraThatStampsWithItsHostsClockHasNoneToPoll) {
  EXPECT_EQ(refusal_by_pi("/cameras/clock_poll/interval_ms", "100"),
            "--set /cameras/clock_poll/interval_ms=100: found 100, allowed 0 where cameras stamp "
            "with their host's clock (/cameras/stamp_clock): they have no other that could be "
            "polled");
  EXPECT_EQ(refusal_of_set("8cam_raspberry_30fps", {{"/cameras/clock_poll/interval_ms", "100"},
                                                    {"/cameras/stamp_clock", "camera"},
                                                    {"/cameras/frame_control", "null"}}),
            "");
  EXPECT_THAT(refusal_of_set("18cam_6host_45fps_lan", {{"/cameras/stamp_clock", "host"}}),
              HasSubstr("/cameras/clock_poll/interval_ms: found 100, allowed 0"));
}

TEST(FrameControl, FramesByTheHostsOscillatorNeedStampsByItToo) {
  EXPECT_THAT(refusal_of_set("5phone_wifi_30fps", {{"/cameras/stamp_clock", "camera"}}),
              HasSubstr("/cameras/frame_control/sensor_clock: found \"host\", allowed \"camera\" "
                        "where the stamps are of the camera's own clock (/cameras/stamp_clock)"));
  EXPECT_THAT(
      refusal_of_set("5phone_wifi_30fps", {{"/cameras/skew_of_camera_ppm", "[1, 2, 3, 4, 5]"}}),
      HasSubstr("/cameras/skew_of_camera_ppm=[1, 2, 3, 4, 5]: found skews, allowed none "
                "where the hosts' oscillators count the frames"));
}

TEST(FrameControl, CamerasWithoutATriggerInputLoad) {
  for (const char* name :
       {"5phone_wifi_30fps", "8cam_raspberry_30fps", "6cam_gige_ptp_60fps", "4oak_poe_30fps"}) {
    const Scenario scenario = load_scenario(name);
    EXPECT_EQ(scenario.cameras.sync_mode, SyncMode::kDefault) << name;
    EXPECT_EQ(scenario.cameras.stamp_clock, ClockOwner::kHost) << name;
    EXPECT_GE(scenario.timeline.warm_up_ms, 6'000) << name;
    ASSERT_TRUE(scenario.cameras.frame_control) << name;
    // A camera is a host itself.
    const std::vector<std::size_t> counts = scenario.cameras_by_host();
    for (std::size_t host = 1; host < counts.size(); ++host) EXPECT_EQ(counts[host], 1U) << name;
  }
}

// The period of a Pixel 3's configuration is a whole number of its sensor's lines.
TEST(FrameControl, ThePhonesPeriodIsTheDocumentedOne) {
  const Scenario scenario = load_scenario("5phone_wifi_30fps");
  EXPECT_NEAR(scenario.trigger.period_ms(), 33.32, 1e-8);
  EXPECT_EQ(scenario.cameras.frame_control->shortest_ms, 33.32);
  EXPECT_EQ(scenario.cameras.frame_control->granularity_us * 4165, 33'320);
}

TEST(FrameControl, WarnsAboutAControlThatTheMakerDoesNotOffer) {
  const auto warned = [](const char* pointer, const char* value) {
    return warnings(load_scenario("5phone_wifi_30fps", {{pointer, value}}));
  };
  EXPECT_THAT(warned("/cameras/frame_control/start_at", "true"),
              ElementsAre("--set /cameras/frame_control/start_at=true: a hypothetical control: no "
                          "Pixel phone, back camera by Camera2 offers it (simbench list cameras)"));
  EXPECT_THAT(warned("/cameras/frame_control/adjust_frame", "true"),
              ElementsAre(HasSubstr("/cameras/frame_control/adjust_frame=true: a hypothetical")));
  EXPECT_THAT(warned("/cameras/frame_control/frame_length", "true"), IsEmpty());
  EXPECT_THAT(warnings(load_scenario("8cam_raspberry_30fps",
                                     {{"/cameras/frame_control/insert_frame", "true"}})),
              ElementsAre(HasSubstr("no Raspberry Pi Camera Module 3 offers it")));
}

TEST(FrameControl, ACameraOfUnknownControlsHasNoWarning) {
  const std::string colour = R"([{"kind": "colour", "width": 1280, "height": 720,
      "bytes_per_pixel": 0.3, "mode_rate_hz": 30, "pipeline_latency_ms": 8,
      "latency_mode_periods": 0, "shutter": "rolling", "readout_ms": 16.7}])";
  EXPECT_THAT(warnings(load_scenario("8cam_raspberry_30fps", {{"/cameras/model", "azure_kinect"},
                                                              {"/cameras/streams", colour}})),
              IsEmpty());
}

// Beside cameras that are hosts, a master without one is a computer; another host is idle.
TEST(FrameControl, OnlyTheMasterMayHaveNoCamera) {
  EXPECT_THAT(warnings(load_scenario("4oak_poe_30fps")), IsEmpty());
  EXPECT_THAT(warnings(load_scenario("4oak_poe_30fps", {{"/hosts/count", "6"}})),
              ElementsAre(HasSubstr("/hosts/count=6: 1 of 6 hosts have no camera")));
}

}  // namespace
}  // namespace simbench::scenarios
