#include "evaluation/run/ad_hoc_pipelines.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "evaluation/run/pipeline_choice.h"

namespace simbench::evaluation {
namespace {

using scenarios::InputError;
using testing::IsEmpty;

constexpr const char* kScenario = "3cam_1host_30fps";

TEST(AdHocPipelines, NamesOfTheScenarioAreLeftToIt) {
  EXPECT_THAT(with_ad_hoc_pipelines(kScenario, {}, {}), IsEmpty());
  EXPECT_THAT(with_ad_hoc_pipelines(kScenario, {}, {"oracle", "no_such"}), IsEmpty());
  EXPECT_THAT(with_ad_hoc_pipelines(kScenario, {}, {"chrony"}), IsEmpty());
}

TEST(AdHocPipelines, AreAppendedOnceAndChosenByTheirText) {
  const std::vector<std::string> names = {"chrony+hull_300+genlock", "oracle"};
  const auto overrides = with_ad_hoc_pipelines(kScenario, {{"/timeline/frames", "20"}}, names);
  ASSERT_EQ(overrides.size(), 2U);
  const scenarios::Scenario scenario = scenarios::load_scenario(kScenario, overrides);
  EXPECT_EQ(scenario.timeline.frames, 20);
  EXPECT_TRUE(scenario.derivation.changes.size() == 1) << "a pipeline is no change of the world";
  const std::vector<PipelineChoice> chosen = choose_pipelines(scenario, names);
  EXPECT_EQ(chosen[0].pipeline.name, names[0]);
  EXPECT_EQ(chosen[0].host_sync.info.name, "chrony");
  EXPECT_EQ(chosen[0].gathering.info.name, "genlock");
  EXPECT_EQ(with_ad_hoc_pipelines(kScenario, {}, {names[0], names[0]}).size(), 1U);
}

TEST(AdHocPipelines, AHostSyncAloneIsOneOfClocks) {
  const auto overrides =
      with_ad_hoc_pipelines(kScenario, {}, {"two_way_hull", "no_such"}, AdHoc::kHostSyncToo);
  ASSERT_EQ(overrides.size(), 1U);
  const nlohmann::json pipeline = nlohmann::json::parse(overrides[0].value);
  EXPECT_EQ(pipeline["name"], "two_way_hull");
  EXPECT_EQ(pipeline["host_sync"], "two_way_hull");
  EXPECT_THROW(with_ad_hoc_pipelines(kScenario, {}, {"a+b"}, AdHoc::kHostSyncToo), InputError);
}

}  // namespace
}  // namespace simbench::evaluation
