// /published_figures: what may be stated, and in which world it holds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "tests/nonempty.h"
#include "tests/scenarios/support.h"
#include "tests/scratch_folder.h"

namespace simbench::scenarios {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

// A figure of a pipeline with these further members, on a line of its own.
std::string figure_of(const std::string& pipeline, const std::string& members) {
  return "\n {\"pipeline\": \"" + pipeline +
         "\", \"metric\": \"amd_ms\", \"conditions\": \"c\", \"source\": \"s\"" + members + "}";
}

std::string figures(const std::string& list) { return "\"published_figures\": [" + list + "]"; }

TEST(PublishedFigures, AreReadAsStated) {
  const Scenario scenario =
      load_derived(figures(figure_of("yoon2021_both", ", \"at_most\": 2.5") + "," +
                           figure_of("yoon2021_time", ", \"value\": 4") + "," +
                           figure_of("yoon2021_time", ", \"at_least\": 3")));
  ASSERT_EQ(scenario.published_figures.size(), 3U);
  const PublishedFigure& bound = scenario.published_figures[0];
  EXPECT_EQ(bound.pipeline, "yoon2021_both");
  EXPECT_EQ(bound.metric, "amd_ms");
  EXPECT_EQ(bound.at_most, 2.5);
  EXPECT_FALSE(bound.value.has_value());
  EXPECT_EQ(bound.conditions, "c");
  EXPECT_EQ(bound.source, "s");
  EXPECT_EQ(bound.number(), 2.5);
  EXPECT_STREQ(bound.number_name(), "at_most");
  EXPECT_EQ(scenario.published_figures[1].number(), 4);
  EXPECT_STREQ(scenario.published_figures[1].number_name(), "value");
  EXPECT_EQ(scenario.published_figures[2].number(), 3);
  EXPECT_STREQ(scenario.published_figures[2].number_name(), "at_least");
}

TEST(PublishedFigures, AScenarioDoesWithout) {
  const Scenario scenario = load_scenario("18cam_6host_45fps");
  EXPECT_THAT(scenario.published_figures, IsEmpty());
  EXPECT_THAT(scenario.resolved_json(), Not(HasSubstr("published_figures")));
}

TEST(PublishedFigures, AreOfAPipelineOfTheScenario) {
  EXPECT_EQ(error_of(figures(figure_of("yoon2021_bot", ", \"value\": 1"))),
            "my.json:4: /published_figures/0/pipeline: found \"yoon2021_bot\", did you mean "
            "yoon2021_both?");
  EXPECT_THAT(error_of(figures(figure_of("x", ", \"value\": 1"))),
              HasSubstr("/published_figures/0/pipeline: found \"x\", allowed ntp_last_set, "));
}

TEST(PublishedFigures, HaveExactlyOneNumber) {
  const std::string allowed = ", allowed exactly one of at_most, value and at_least";
  EXPECT_EQ(error_of(figures(figure_of("yoon2021_both", ""))),
            "my.json:4: /published_figures/0: found none of them" + allowed);
  EXPECT_EQ(error_of(figures(figure_of("yoon2021_both", ", \"value\": 1") + "," +
                             figure_of("yoon2021_both", ", \"value\": 1, \"at_most\": 1"))),
            "my.json:5: /published_figures/1: found at_most, value" + allowed);
}

TEST(PublishedFigures, HaveConditionsAndASource) {
  EXPECT_EQ(error_of(figures(R"({"pipeline": "yoon2021_both", "metric": "amd_ms", "value": 1,
                                 "conditions": "c"})")),
            "my.json:3: /published_figures/0/source: found nothing, allowed text of 1 to 1000 "
            "characters");
  EXPECT_THAT(error_of(figures(figure_of("yoon2021_both", ", \"below\": 1"))),
              HasSubstr("/published_figures/0/below: found an unknown key"));
  EXPECT_THAT(error_of("\"published_figures\": {}"),
              HasSubstr("/published_figures: found an object, allowed an array of 0 to 1000"));
}

// A base "base.json" with two figures, and a scenario over it.
class InheritedFigures : public testing::Test {
 protected:
  Scenario load_over(const std::string& members) const {
    folder_.write("base.json", derived(figures(figure_of("yoon2021_both", ", \"value\": 2") + "," +
                                               figure_of("yoon2021_time", ", \"at_most\": 5"))));
    return load_scenario(folder_.write(
        "mine.json", R"({"base": "base.json", "name": "mine", "summary": "s")" + members + "}"));
  }

  ScratchFolder folder_;
};

TEST_F(InheritedFigures, HoldInTheSameWorld) {
  EXPECT_EQ(load_over("").published_figures.size(), 2U);
  EXPECT_EQ(load_over(R"(, "evaluation": {"table": "leaderboard"})").published_figures.size(), 2U);
}

TEST_F(InheritedFigures, GoWithTheWorld) {
  const Scenario scenario = load_over(R"(, "timeline": {"frames": 60})");
  EXPECT_THAT(scenario.published_figures, IsEmpty());
  EXPECT_THAT(scenario.resolved_json(), Not(HasSubstr("published_figures")));
  EXPECT_EQ(scenario.derivation.unpublished, "my");
}

TEST_F(InheritedFigures, GoWithTheirPipeline) {
  const Scenario scenario = load_over(
      R"(, "pipelines": [{"name": "yoon2021_time", "host_sync": "yoon2021_time",
                          "device_time": "regression_30", "gathering": "yoon2021"},
                         {"name": "yoon2021_both", "host_sync": "oracle",
                          "device_time": "regression_30", "gathering": "yoon2021"}])");
  ASSERT_EQ(scenario.published_figures.size(), 1U);
  EXPECT_EQ(scenario.published_figures[0].pipeline, "yoon2021_time");
  // The one that is kept has moved up, with its place.
  EXPECT_THAT(scenario.origin->describe("/published_figures/0/at_most"),
              HasSubstr("base.json:5: /published_figures/0/at_most"));
}

TEST_F(InheritedFigures, AreReplacedByTheScenariosOwn) {
  const Scenario scenario = load_over(", \"timeline\": {\"frames\": 60}, " +
                                      figures(figure_of("yoon2021_both", ", \"at_least\": 1")));
  ASSERT_EQ(scenario.published_figures.size(), 1U);
  EXPECT_EQ(scenario.published_figures[0].at_least, 1);
  EXPECT_THAT(load_over(", \"published_figures\": null").published_figures, IsEmpty());
}

TEST(PublishedFigures, OfABuiltinGoWithItsWorld) {
  EXPECT_EQ(load_scenario("5phone_wifi_30fps").published_figures.size(), 1U);
  const Scenario changed = load_scenario("5phone_wifi_30fps", {{"/timeline/frames", "7"}});
  EXPECT_THAT(changed.published_figures, IsEmpty());
  EXPECT_EQ(changed.derivation.unpublished, "5phone_wifi_30fps");
  const Scenario again = load_scenario_text(changed.resolved_json(), "manifest.json");
  EXPECT_EQ(again.derivation.unpublished, "5phone_wifi_30fps");
}

// docs/reference/capture_alignment.md section 10.
TEST(PublishedFigures, OfTheAlignmentScenarios) {
  struct Stated {
    const char* scenario;
    const char* pipeline;
    const char* metric;
    double at_most;
  };
  for (const Stated& stated :
       {Stated{"5phone_wifi_30fps", "libsoftwaresync", "exposure_spread_median_ms", 0.25},
        Stated{"8cam_raspberry_30fps", "rpi_sync", "exposure_spread_median_ms", 0.1},
        Stated{"4oak_poe_30fps", "pid_frame_rate", "exposure_spread_p95_ms", 1}}) {
    const Scenario scenario = load_scenario(stated.scenario);
    ASSERT_EQ(scenario.published_figures.size(), 1U) << stated.scenario;
    const PublishedFigure& figure = scenario.published_figures.front();
    EXPECT_EQ(figure.pipeline, stated.pipeline);
    EXPECT_EQ(figure.metric, stated.metric);
    EXPECT_EQ(figure.at_most, stated.at_most);
  }
}

// Section 6.
TEST(PublishedFigures, OfTheGlassesAreOfTheirClocks) {
  const Scenario scenario = load_scenario("2glasses_wifi_30fps");
  ASSERT_EQ(scenario.published_figures.size(), 2U);
  for (const PublishedFigure& figure : nonempty(scenario.published_figures)) {
    EXPECT_THAT(figure.pipeline, StartsWith("ticsync"));
    EXPECT_EQ(figure.metric, "host_error_ms");
    EXPECT_EQ(figure.at_most, 1);
  }
  EXPECT_EQ(std::get<double>(scenario.algorithms.at("two_way").at("warm_up_s")), 39);
}

// Section 5: nobody shall take the agreement for a test.
TEST(PublishedFigures, OfTheLedRigIsCalledAFit) {
  const Scenario scenario = load_scenario("25cam_led_30fps");
  ASSERT_EQ(scenario.published_figures.size(), 1U);
  const PublishedFigure& figure = scenario.published_figures.front();
  EXPECT_EQ(figure.pipeline, "rocsync_led.hardware_sync");
  EXPECT_EQ(figure.metric, "rmdv_ms");
  EXPECT_EQ(figure.value, 1.34);
  EXPECT_THAT(figure.conditions, HasSubstr("A fit, no test"));
  EXPECT_THAT(figure.source, HasSubstr("fitted"));
}

}  // namespace
}  // namespace simbench::scenarios
