// Groups of cameras in a scenario: what they replace, and what is refused.
#include "scenarios/camera_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kMixed = "6cam_mixed_models_30fps";

std::string error_of_mixed(const std::vector<Override>& overrides) {
  try {
    load_scenario(kMixed, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CameraGroups, AScenarioWithoutGroupsHasOneOfAllCameras) {
  const Scenario scenario = load_scenario("18cam_6host_45fps");
  EXPECT_EQ(group_count(scenario.cameras), 1U);
  EXPECT_EQ(group_of_cameras(scenario.cameras), std::vector<std::size_t>(18, 0));
  EXPECT_EQ(group_alone(scenario, 0).resolved_json(), scenario.resolved_json());
}

TEST(CameraGroups, AGroupStatesWhatDiffers) {
  const Scenario scenario = load_scenario(kMixed);
  EXPECT_THAT(group_of_cameras(scenario.cameras), ElementsAre(0, 0, 0, 1, 1, 1));
  const Scenario first = group_alone(scenario, 0);
  EXPECT_EQ(first.cameras.model, "flir_bfs_u3_31s4");
  EXPECT_EQ(first.cameras.count, 3);
  EXPECT_EQ(first.cameras.streams.front().width, 2048);
  const Scenario second = group_alone(scenario, 1);
  EXPECT_EQ(second.cameras.model, "basler_aca1920_155um");
  EXPECT_EQ(second.cameras.streams.front().width, 1920);
  EXPECT_EQ(second.cameras.trigger_to_exposure_us, 19);
  EXPECT_EQ(second.cameras.exposure_ms, scenario.cameras.exposure_ms);
  EXPECT_THAT(second.cameras.host_of_camera, ElementsAre(1, 1, 1));
}

TEST(CameraGroups, ListsOfCamerasAreCut) {
  const Scenario scenario =
      load_scenario(kMixed, {{"/trigger/delay_of_camera_us", "[1, 2, 3, 4, 5, 6]"},
                             {"/cameras/skew_of_camera_ppm", "[0, 1, 2, 3, 4, 5]"}});
  const Scenario second = group_alone(scenario, 1);
  EXPECT_THAT(second.trigger.delay_of_camera_us, ElementsAre(4, 5, 6));
  EXPECT_THAT(second.cameras.skew_of_camera_ppm, ElementsAre(3, 4, 5));
}

TEST(CameraGroups, HoldAllCameras) {
  EXPECT_THAT(error_of_mixed({{"/cameras/groups/1/count", "2"}}),
              HasSubstr("/cameras/groups: found groups of 5 cameras together, allowed 6 "
                        "(/cameras/count)"));
}

TEST(CameraGroups, ExposeTogetherAtSomePulses) {
  EXPECT_THAT(error_of_mixed({{"/cameras/groups/0/pulses_per_frame", "29"},
                              {"/cameras/groups/1/pulses_per_frame", "31"}}),
              HasSubstr("/cameras/groups/1/pulses_per_frame=31: found 31, with which all cameras "
                        "expose at one pulse in 899, allowed at least one of the 600 pulses"));
}

TEST(CameraGroups, AControllerIsOfOneGroup) {
  EXPECT_THAT(error_of_mixed({{"/usb/cameras_per_controller", "2"}}), IsEmpty());
  EXPECT_THAT(error_of_mixed({{"/usb/cameras_per_controller", "2"},
                              {"/hosts/count", "1"},
                              {"/cameras/cameras_per_host", "6"}}),
              HasSubstr("found 2, by which camera 3 of group 1 is on the controller of camera 2 of "
                        "group 0, allowed controllers of one group: 1 makes them so"));
}

TEST(CameraGroups, AGroupAnswersThePulsesThatItGets) {
  EXPECT_THAT(error_of_mixed({{"/trigger/rate_hz", "50"}}), IsEmpty());
  EXPECT_THAT(error_of_mixed({{"/cameras/groups/1/mode_rate_hz", "15"}}),
              HasSubstr("/cameras/groups/1/mode_rate_hz=15: found 15, which does not answer each "
                        "of 30 pulses a second (one in 1 of /trigger/rate_hz), allowed at least "
                        "that rate; a pulses_per_frame of the group changes the pulses that it "
                        "gets"));
  EXPECT_THAT(error_of_mixed({{"/cameras/groups/1/mode_rate_hz", "15"},
                              {"/cameras/groups/1/pulses_per_frame", "2"}}),
              IsEmpty());
  EXPECT_THAT(error_of_mixed({{"/cameras/sync_mode", "default"},
                              {"/cameras/streams/0/mode_rate_hz", "30"},
                              {"/cameras/groups/1/pulses_per_frame", "2"}}),
              HasSubstr("/cameras/groups/1/pulses_per_frame=2: found 2, allowed 1: in sync mode "
                        "\"default\" the colour stream gets no pulses"));
}

// A camera whose exposures begin at the pulse takes any slower pulses, others those near their
// mode.
TEST(CameraGroups, SlowerPulses) {
  EXPECT_THAT(error_of_mixed({{"/trigger/rate_hz", "12"}}), IsEmpty());
  EXPECT_THAT(error_of_set("/trigger/rate_hz", "30"), IsEmpty());  // genlock
}

TEST(CameraGroups, AGroupWithFewerPulsesIsARigWithASlowerTrigger) {
  const Scenario scenario = load_scenario(kMixed, {{"/cameras/groups/1/pulses_per_frame", "3"},
                                                   {"/cameras/exposure_camera_periods", "0.06"}});
  EXPECT_EQ(pulses_per_frame(scenario.cameras, 0), 1);
  EXPECT_EQ(pulses_per_frame(scenario.cameras, 1), 3);
  const Scenario second = group_alone(scenario, 1);
  EXPECT_EQ(second.trigger.rate_hz, 10);
  EXPECT_DOUBLE_EQ(second.cameras.exposure_camera_periods * second.trigger.period_ms(),
                   scenario.cameras.exposure_camera_periods * scenario.trigger.period_ms());
}

TEST(CameraGroups, AGroupsModelHasWhatIsAskedOfIt) {
  EXPECT_THAT(error_of_mixed({{"/cameras/groups/1/width", "1280"}}),
              HasSubstr("found colour 1280x1200, allowed 1920x1200 (profiles of the ace U "
                        "acA1920-155um)"));
  EXPECT_THAT(error_of_mixed({{"/cameras/groups/1/model", "webcam"}}),
              HasSubstr("found \"webcam\", allowed astra_plus"));
  EXPECT_THAT(error_of_mixed({{"/cameras/groups/1/model", "raspberry_camera_v3"}}),
              HasSubstr("/cameras/groups/1/model=raspberry_camera_v3: found "
                        "\"raspberry_camera_v3\", which has no sync mode "
                        "\"slave\""));
  EXPECT_THAT(error_of_mixed({{"/cameras/groups/1/readout_ms", "3"}}),
              HasSubstr("/cameras/groups/1/readout_ms=3: found 3, allowed 0: the ace U "
                        "acA1920-155um has a global shutter"));
}

TEST(CameraGroups, WhatKnowsOneKindOfCamerasIsRefused) {
  EXPECT_THAT(error_of_mixed({{"/cameras/streams/0/calibrated_delay_ms", "20"},
                              {"/cameras/streams/0/calibrated_at",
                               "{\"width\": 2048, \"height\": 1536, \"mode_rate_hz\": 30}"}}),
              HasSubstr("found 20, allowed null with /cameras/groups"));
}

// 2048 x 1536 bytes at 30 Hz are 94 MB/s, 1920 x 1200 are 69.
TEST(CameraGroups, WarningsNameTheGroup) {
  EXPECT_THAT(warnings(load_scenario(kMixed)), IsEmpty());
  EXPECT_THAT(warnings(load_scenario(kMixed, {{"/usb/bandwidth_mb_per_s", "80"}})),
              ElementsAre(HasSubstr("group 0 of /cameras/groups: 1 camera on a controller")));
}

}  // namespace
}  // namespace simbench::scenarios
