// What the scenarios say the paper published is what tests/data/published.json has of its tables.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/loader.h"
#include "tests/data/test_data.h"

namespace simbench::scenarios {
namespace {

using Json = nlohmann::json;

const std::map<std::string, std::string> kPipelineOfDelay = {{"none", "ntp_last_set"},
                                                             {"network", "yoon2021_network"},
                                                             {"time", "yoon2021_time"},
                                                             {"both", "yoon2021_both"}};

void expect_table(const std::string& table, const std::string& scenario_name) {
  const Json rows = test_data_json("published.json").at(table);
  const Scenario scenario = load_scenario(scenario_name);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(scenario.published.size(), rows.size());
  for (const Json& row : rows) {
    const Published& found = scenario.published.at(kPipelineOfDelay.at(row.at("delay")));
    EXPECT_EQ(found.amd_ms, row.at("amd_ms")) << row;
    EXPECT_EQ(found.rmdv_ms, row.at("rmdv_ms")) << row;
  }
}

TEST(PublishedValues, OfTable2) { expect_table("table2", "18cam_6host_15fps"); }

TEST(PublishedValues, OfTable3) { expect_table("table3", "18cam_6host_45fps"); }

TEST(PublishedValues, OfTable4) {
  const Json rows = test_data_json("published.json").at("table4_reprojection_cm");
  const Scenario scenario = load_scenario("18cam_6host_30fps_studio");
  ASSERT_TRUE(scenario.studio.has_value());
  const std::map<std::string, std::string> pipeline_of_method = {
      {"realsense_sync_with_ntp", "ntp_last_set"}, {"proposed_sync", "yoon2021_both"}};
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(scenario.studio->published.size(), rows.size());
  for (const Json& row : rows) {
    const auto& found = scenario.studio->published.at(pipeline_of_method.at(row.at("method")));
    EXPECT_EQ(found.mean_cm, row.at("mean_cm")) << row;
    EXPECT_EQ(found.std_cm, row.at("std_cm")) << row;
  }
}

TEST(PublishedValues, TheRigIsThePapers) {
  const Json rig = test_data_json("published.json").at("rig");
  for (const char* name : {"18cam_6host_15fps", "18cam_6host_45fps"}) {
    const Scenario scenario = load_scenario(name);
    EXPECT_EQ(scenario.cameras.count, rig.at("cameras")) << name;
    EXPECT_EQ(scenario.hosts.count, rig.at("hosts")) << name;
    EXPECT_EQ(scenario.cameras.cameras_per_host, rig.at("cameras_per_host")) << name;
    EXPECT_EQ(scenario.timeline.frames, rig.at("frames_offline")) << name;
    EXPECT_EQ(scenario.timeline.warm_up_ms, 1000 * rig.at("unstable_start_s").get<double>());
    const std::int64_t of_branch = scenario.trigger.cameras_per_sub_trigger;
    EXPECT_EQ(of_branch, rig.at("cameras_per_sub_trigger")) << name;
    EXPECT_EQ(scenario.cameras.count, of_branch * rig.at("sub_triggers").get<std::int64_t>());
  }
}

// Section 2.1: the Kinect Azure has the largest colour image and a supply of its own, the D400
// alone has 90 fps and the largest depth image.
TEST(PublishedValues, Table1SaysWhatTheTextSays) {
  const Json cameras = test_data_json("published.json").at("table1_cameras");
  ASSERT_EQ(cameras.size(), 6U);
  const auto pixels = [](const Json& size) {
    return size.at(0).get<std::int64_t>() * size.at(1).get<std::int64_t>();
  };
  for (const Json& camera : cameras) {
    const std::string name = camera.at("name");
    const bool is_kinect = name == "Kinect Azure";
    const bool is_d400 = name == "RealSense D455" || name == "RealSense D435";
    EXPECT_EQ(camera.at("power").get<std::string>().starts_with("DC"), is_kinect) << name;
    EXPECT_EQ(pixels(camera.at("rgb_30fps")) == 3840 * 2160, is_kinect) << name;
    EXPECT_LE(pixels(camera.at("rgb_30fps")), 3840 * 2160) << name;
    EXPECT_EQ(!camera.at("depth_90fps").is_null(), is_d400) << name;
    EXPECT_EQ(pixels(camera.at("depth_30fps")) == 1280 * 720, is_d400) << name;
    EXPECT_LE(pixels(camera.at("depth_30fps")), 1280 * 720) << name;
    EXPECT_EQ(camera.at("multi_camera") == "yes", is_d400) << name;
  }
}

}  // namespace
}  // namespace simbench::scenarios
