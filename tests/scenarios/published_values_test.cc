// What the scenarios say the paper published is what tests/data/published.json has of its tables.
#include <gtest/gtest.h>

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
  }
}

}  // namespace
}  // namespace simbench::scenarios
