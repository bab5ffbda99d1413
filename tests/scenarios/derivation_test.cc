// What a scenario says of itself once its world is another than that of the scenario it rests on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/scenarios/support.h"
#include "tests/scratch_folder.h"

namespace simbench::scenarios {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Scenario load_changed(const std::vector<Override>& overrides) {
  return load_scenario("18cam_6host_45fps", overrides);
}

std::string changes_of(const Scenario& scenario) { return changed_text(scenario.derivation); }
std::string heading(const Scenario& scenario) { return named(scenario.name, scenario.derivation); }

TEST(Derivation, OfASetIsItsOldAndItsNewValue) {
  const Scenario scenario =
      load_changed({{"/cameras/count", "12"}, {"/hosts/count", "4"}, {"/trigger/rate_hz", "30"}});
  EXPECT_EQ(changes_of(scenario),
            "changed: /hosts/count 6 → 4, /trigger/rate_hz 45 → 30, /cameras/count 18 → 12");
  EXPECT_EQ(heading(scenario), "18cam_6host_45fps (changed)");
  EXPECT_EQ(changed_text(scenario.derivation, 1), "changed: /hosts/count 6 → 4, and 2 more");
}

TEST(Derivation, OfEveryBuiltinIsNone) {
  for (const BuiltinScenario& each : builtin_scenarios()) {
    const Scenario scenario = load_scenario(each.name);
    EXPECT_EQ(changes_of(scenario), "") << each.name;
    EXPECT_EQ(heading(scenario), each.name);
    EXPECT_EQ(scenario.summary, each.summary);
  }
}

TEST(Derivation, OfAnOwnScenarioIsFromTheNearestBuiltin) {
  const ScratchFolder folder;
  folder.write("one.json",
               R"({"base": "18cam_6host_15fps", "name": "one", "summary": "own words",
                   "timeline": {"frames": 7}})");
  const std::string two =
      folder.write("two.json", R"({"base": "one.json", "name": "two", "summary": "s",
                                                       "usb": {"buffered_frames": 9}})");
  const Scenario scenario = load_scenario(two, {{"/hosts/nic/hardware_stamps", "true"}});
  EXPECT_EQ(heading(scenario), "two (based on 18cam_6host_15fps)");
  EXPECT_EQ(changes_of(scenario),
            "changed: /timeline/frames 480 → 7, /hosts/nic/hardware_stamps false → true, "
            "/usb/buffered_frames 4 → 9");
}

TEST(Derivation, OfACompleteFileIsFromTheFile) {
  Scenario complete = load_scenario("3cam_1host_30fps");
  std::string text = complete.resolved_json();
  text.replace(text.find("3cam_1host_30fps"), 16, "mine");
  EXPECT_EQ(heading(load_scenario_text(text, "mine.json")), "mine");
  const Scenario set = load_scenario_text(text, "mine.json", {{"/timeline/frames", "8"}});
  EXPECT_EQ(heading(set), "mine (changed)");
  EXPECT_THAT(changes_of(set), HasSubstr("/timeline/frames "));
  EXPECT_THAT(set.summary, HasSubstr("frames: 8"));
}

TEST(Derivation, HasListsFaultsAndParametersOfAlgorithms) {
  const Scenario scenario =
      load_changed({{"/faults", R"([{"kind": "clock_step", "host": 1, "at_ms": 2, "step_ms": 3}])"},
                    {"/cameras/host_of_camera", "[0,0,0,1,1,1,2,2,2,3,3,3,4,4,4,5,5,5]"},
                    {"/algorithms/yoon2021/stamps", "null"},
                    {"/algorithms/chrony/gain", "0.5"}});
  EXPECT_THAT(changes_of(scenario),
              AllOf(HasSubstr("/faults/0/kind none → clock_step"), HasSubstr("/faults/0/step_ms"),
                    HasSubstr("/cameras/host_of_camera [] → [0,0,0,1,1,1,2,2,2,3,3,3,4,4,4,5,5,5]"),
                    HasSubstr("/algorithms/yoon2021/stamps 100 → none"),
                    HasSubstr("/algorithms/chrony/gain none → 0.5")));
}

TEST(Derivation, HasNoWordsAboutTheWorldAndNoChoiceOfPipelines) {
  const Scenario scenario = load_derived(
      R"("evaluation": {"table": "leaderboard"},
         "pipelines": [{"name": "oracle", "host_sync": "oracle", "device_time": "regression_30",
                        "gathering": "yoon2021"}])");
  EXPECT_THAT(scenario.derivation.changes, IsEmpty());
  EXPECT_EQ(heading(scenario), "my (based on 18cam_6host_45fps)");
}

TEST(Derivation, APipelineThatKeepsItsNameAloneIsAChange) {
  const Scenario scenario = load_changed({{"/pipelines/4/host_sync", "oracle"}});
  EXPECT_EQ(changes_of(scenario), "changed: /pipelines/4/host_sync yoon2021_both → oracle");
  EXPECT_EQ(scenario.published.count("yoon2021_both"), 0U);
  EXPECT_EQ(scenario.published.count("yoon2021_time"), 1U);
}

TEST(Derivation, OutlivesTheResolvedText) {
  const Scenario scenario = load_changed({{"/trigger/rate_hz", "30"}});
  const Scenario again = load_scenario_text(scenario.resolved_json(), "manifest.json");
  EXPECT_EQ(changes_of(again), changes_of(scenario));
  EXPECT_EQ(again.derivation.unpublished, scenario.derivation.unpublished);
  EXPECT_EQ(again.resolved_json(), scenario.resolved_json());
}

TEST(PublishedWorld, HoldsTheValuesOfTheScenarioThatStatesThem) {
  EXPECT_EQ(load_changed({}).published.size(), 4U);
  EXPECT_EQ(load_derived(R"("evaluation": {"table": "pipelines"})").published.size(), 4U);
  EXPECT_EQ(load_scenario("18cam_6host_15fps").published.size(), 4U);
  for (const Override& change :
       {Override{"/trigger/rate_hz", "30"}, Override{"/algorithms/yoon2021/stamps", "50"},
        Override{"/evaluation/gathering_interval_periods", "0.4"}}) {
    const Scenario scenario = load_changed({change});
    EXPECT_THAT(scenario.published, IsEmpty()) << change.pointer;
    EXPECT_THAT(unpublished_text(scenario.derivation), HasSubstr("18cam_6host_45fps"));
  }
  EXPECT_EQ(unpublished_text(load_changed({}).derivation), "");
}

// Its hosts have more than those of the fit, whose values it would inherit.
TEST(PublishedWorld, IsNotThatOfABuiltinThatChangesIt) {
  const Scenario scenario = load_scenario("leaderboard_calibrated");
  EXPECT_THAT(scenario.published, IsEmpty());
  EXPECT_THAT(unpublished_text(scenario.derivation), HasSubstr("18cam_6host_45fps"));
}

TEST(PublishedWorld, OfAnOwnScenarioIsItsOwn) {
  const std::string own = R"("timeline": {"frames": 60},
      "published": {"yoon2021_both": {"amd_ms": 2, "rmdv_ms": 1}})";
  const Scenario scenario = load_derived(own);
  ASSERT_EQ(scenario.published.size(), 1U);
  EXPECT_EQ(scenario.published.at("yoon2021_both").amd_ms, 2);
  EXPECT_THAT(load_derived(own, {{"/timeline/frames", "61"}}).published, IsEmpty());
}

TEST(PublishedWorld, HoldsForStudiosToo) {
  EXPECT_EQ(load_scenario("18cam_6host_30fps_studio").studio->published.size(), 2U);
  const Scenario scenario =
      load_scenario("18cam_6host_30fps_studio", {{"/studio/subject/walk_speed_m_per_s", "0.5"}});
  EXPECT_THAT(scenario.studio->published, IsEmpty());
  EXPECT_EQ(scenario.derivation.unpublished, "18cam_6host_30fps_studio");
}

TEST(Summary, OfAChangedWorldIsDrawnFromIt) {
  const Scenario scenario = load_changed({{"/cameras/count", "12"}, {"/hosts/count", "4"}});
  EXPECT_EQ(scenario.summary,
            "Cameras: 12, hosts: 4, frames: 480, sync mode genlock, trigger at 45 Hz, depth of 848 "
            "x 480 at 45 Hz.");
  EXPECT_THAT(scenario.resolved_json(), Not(HasSubstr("18 cameras in genlock")));
}

TEST(Summary, OfAnOwnScenarioStaysUntilItsWorldIsChanged) {
  const std::string own = R"("timeline": {"frames": 60})";
  EXPECT_EQ(load_derived(own).summary, "s");
  EXPECT_THAT(load_derived(own, {{"/timeline/frames", "61"}}).summary, HasSubstr("frames: 61"));
  EXPECT_EQ(load_derived(own, {{"/timeline/frames", "61"}, {"/summary", "mine"}}).summary, "mine");
}

}  // namespace
}  // namespace simbench::scenarios
