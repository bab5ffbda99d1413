// Elements of a list that state only what differs from the base's.
#include "scenarios/merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/loader.h"
#include "scenarios/scenario_json.h"

namespace simbench::scenarios {
namespace {

using testing::HasSubstr;

Scenario of(const std::string& members, const std::string& base = "18cam_6host_45fps_lan") {
  return load_scenario_text(
      R"({"base": ")" + base + R"(", "name": "mine", "summary": "s", )" + members + "}", "my.json");
}

std::string error_of_members(const std::string& members) {
  try {
    of(members);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

nlohmann::json streams_of(const Scenario& scenario) {
  return nlohmann::json(scenario)["cameras"]["streams"];
}

TEST(Merge, APartialElementChangesTheBasesAtItsPlace) {
  const nlohmann::json before = streams_of(load_scenario("18cam_6host_90fps_full_slave"));
  ASSERT_EQ(before.size(), 2U);
  const nlohmann::json after = streams_of(of(R"("cameras": {"streams": [
      {}, {"pipeline_latency_ms": 3.5}]})",
                                             "18cam_6host_90fps_full_slave"));
  nlohmann::json expected = before;
  expected[1]["pipeline_latency_ms"] = 3.5;
  EXPECT_EQ(after, expected);
}

TEST(Merge, ACompleteElementStandsForItself) {
  const std::string stated =
      R"("kind": "depth", "width": 848, "height": 480, "bytes_per_pixel": 2, "mode_rate_hz": 90,
         "pipeline_latency_ms": 1, "latency_mode_periods": 2, "shutter": "global", "readout_ms": 0)";
  const std::string calibrated =
      R"(, "calibrated_delay_ms": 7,
         "calibrated_at": {"width": 848, "height": 480, "mode_rate_hz": 90})";
  const std::string base =
      R"({"base": "18cam_6host_45fps_lan", "name": "mine", "summary": "s", "cameras":
                             {"streams": [{)" +
      stated;
  EXPECT_EQ(load_scenario_text(base + calibrated + "}]}}", "my.json")
                .cameras.streams[0]
                .calibrated_delay_ms,
            7);
  // What another file's element leaves out of its own accord does not come from below.
  EXPECT_EQ(load_scenario_text(base + "}]}}", "my.json").cameras.streams[0].calibrated_delay_ms,
            std::nullopt);
}

TEST(Merge, TheListIsAsLongAsTheFiles) {
  EXPECT_EQ(
      of(R"("cameras": {"streams": [{}]})", "18cam_6host_90fps_full_slave").cameras.streams.size(),
      1U);
  EXPECT_EQ(of(R"("trigger": {"pauses": []})").trigger.pauses.size(), 0U);
}

TEST(Merge, AnElementWithoutOneBelowItMustBeComplete) {
  EXPECT_THAT(error_of_members(R"("cameras": {"streams": [{}, {"mode_rate_hz": 30}]})"),
              HasSubstr("my.json:1: /cameras/streams/1/"));
  EXPECT_THAT(error_of_members(R"("cameras": {"streams": [{}, {"mode_rate_hz": 30}]})"),
              HasSubstr("found nothing, allowed"));
}

TEST(Merge, AMessageNamesTheLineThatTheUserWrote) {
  EXPECT_THAT(error_of_members("\"cameras\": {\"streams\": [\n{\"mode_rate_hz\": 31}]}"),
              HasSubstr("my.json:2: /cameras/streams/0/mode_rate_hz: found 31"));
}

TEST(Merge, NullTakesAMemberOfTheBasesElementAway) {
  nlohmann::json target = {
      {"network", {{"links", {{{"host", 1}, {"latency_fixed_ms", 2}, {"asymmetry_ms", 1}}}}}}};
  Places places;
  const nlohmann::json patch = {
      {"network", {{"links", {{{"latency_fixed_ms", 3}, {"asymmetry_ms", nullptr}}}}}}};
  merge_patch(patch, Places(), target, places);
  EXPECT_EQ(target["network"]["links"], nlohmann::json({{{"host", 1}, {"latency_fixed_ms", 3}}}));
}

// A name says which pipeline it is; its place does not.
TEST(Merge, PipelinesGoByTheirNames) {
  EXPECT_THAT(error_of_members(R"("pipelines": [{"name": "a", "host_sync": "chrony"}])"),
              HasSubstr("/pipelines/0/"));
}

}  // namespace
}  // namespace simbench::scenarios
