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
  EXPECT_EQ(chosen[0].host_sync.info().name, "chrony");
  EXPECT_EQ(chosen[0].gathering.info().name, "genlock");
  EXPECT_EQ(with_ad_hoc_pipelines(kScenario, {}, {names[0], names[0]}).size(), 1U);
}

TEST(AdHocPipelines, AHostSyncAloneIsOneOfClocks) {
  const auto overrides =
      with_ad_hoc_pipelines(kScenario, {}, {"two_way_hull", "no_such"}, AdHoc::kHostSyncToo);
  ASSERT_EQ(overrides.size(), 1U);
  const nlohmann::json pipeline = nlohmann::json::parse(overrides[0].value);
  EXPECT_EQ(pipeline["name"], "two_way_hull");
  EXPECT_EQ(pipeline["host_sync"], "two_way_hull");
  EXPECT_FALSE(pipeline.contains("capture_alignment"));
  for (const char* wrong : {"a+b", "a+b+c+d+e", "a+b++d"}) {
    EXPECT_THROW(with_ad_hoc_pipelines(kScenario, {}, {wrong}, AdHoc::kHostSyncToo), InputError);
  }
}

TEST(AdHocPipelines, FourPartsSteerTheExposures) {
  const std::vector<std::string> names = {"oracle+phase_rate+hull_300+yoon2021", "oracle"};
  constexpr const char* kPhones = "5phone_wifi_30fps";
  const scenarios::Scenario scenario = scenarios::load_scenario(
      kPhones, with_ad_hoc_pipelines(kPhones, {}, names, AdHoc::kHostSyncToo));
  const std::vector<PipelineChoice> chosen = choose_pipelines(scenario, names);
  EXPECT_EQ(chosen[0].host_sync.info().name, "oracle");
  EXPECT_EQ(chosen[0].capture_alignment.info().name, "phase_rate");
  EXPECT_EQ(chosen[0].device_time.info().name, "hull_300");
  EXPECT_EQ(chosen[0].gathering.info().name, "yoon2021");
}

TEST(AdHocPipelines, AHostSyncAloneHasTheFirstPipelinesAlignment) {
  constexpr const char* kPhones = "5phone_wifi_30fps";
  const auto overrides = with_ad_hoc_pipelines(kPhones, {}, {"chrony"}, AdHoc::kHostSyncToo);
  ASSERT_EQ(overrides.size(), 1U);
  EXPECT_EQ(nlohmann::json::parse(overrides[0].value)["capture_alignment"], "libsoftwaresync");
}

}  // namespace
}  // namespace simbench::evaluation
