// Pipelines that a file takes from another scenario.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "scenarios/builtin_files.h"
#include "scenarios/schema.h"
#include "tests/nonempty.h"
#include "tests/scenarios/support.h"
#include "tests/scratch_folder.h"

namespace simbench::scenarios {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> rows_of(const Scenario& scenario) {
  std::vector<std::string> rows;
  for (const Pipeline& each : scenario.pipelines) {
    rows.push_back(each.name + "=" + each.host_sync + "+" + each.device_time);
  }
  return rows;
}

Scenario with_items(const std::string& items) {
  return load_derived("\"pipelines\": [\n" + items + "]");
}

TEST(IncludedPipelines, ComeInTheirOrderWithWhatIsStatedHere) {
  const Scenario scenario = with_items(
      R"({"from": "leaderboard_lan", "names": ["genlock", "host.gn*", "oracle"]},
         {"name": "mine", "host_sync": "chrony", "device_time": "hull_300", "gathering": "yoon2021"},
         {"from": "leaderboard_lan", "names": ["host.sptp_*"], "except": ["host.sptp_hardware"],
          "device_time": "hull_300"})");
  EXPECT_THAT(rows_of(scenario),
              ElementsAre("oracle=oracle+oracle", "genlock=free_running+sensor_normalised",
                          "host.gnss=gnss+two_way_poll_calibrated", "mine=chrony+hull_300",
                          "host.sptp_software=sptp_software+hull_300"));
}

TEST(IncludedPipelines, AllOfThemWithoutNames) {
  const std::vector<std::string> theirs =
      rows_of(load_scenario("leaderboard_lan_ideal_calibration"));
  EXPECT_EQ(rows_of(with_items(R"({"from": "leaderboard_lan_ideal_calibration"})")), theirs);
  EXPECT_GT(theirs.size(), 60U);
}

TEST(IncludedPipelines, MessagesNameTheLineThatTookThem) {
  const Scenario scenario = with_items(
      "{\"from\": \"leaderboard_lan\", \"names\": [\"oracle\", \"genlock\"]},\n"
      "{\"name\": \"mine\", \"host_sync\": \"chrony\", \"device_time\": \"hull_300\",\n"
      "\"gathering\": \"yoon2021\"}");
  const auto place = [&scenario](const std::string& pointer) {
    return scenario.origin->describe(pointer);
  };
  EXPECT_EQ(place("/pipelines/1/gathering"), "my.json:4: /pipelines/1/gathering");
  EXPECT_EQ(place("/pipelines/2/gathering"), "my.json:6: /pipelines/2/gathering");
}

TEST(IncludedPipelines, WhatIsNoSuchItemIsRefused) {
  const auto error = [](const std::string& item) {
    return error_of("\"pipelines\": [" + item + "]");
  };
  EXPECT_EQ(error(R"({"from": 7})"), "my.json:3: /pipelines/0/from: found 7, allowed: a scenario");
  EXPECT_EQ(error(R"({"from": "leaderboard_lan", "names": "host.*"})"),
            "my.json:3: /pipelines/0/names: found \"host.*\", allowed: a list of names");
  EXPECT_EQ(error(R"({"from": "leaderboard_lan", "names": ["hosts.*"]})"),
            "my.json:3: /pipelines/0/names: found \"hosts.*\", allowed: the name of a pipeline "
            "there, or its begin and *");
  EXPECT_EQ(error(R"({"from": "leaderboard_lan", "names": []})"),
            "my.json:3: /pipelines/0: found no pipeline, allowed: names of which there is one");
  EXPECT_EQ(error(R"({"name": "mine", "names": ["host.*"]})"),
            "my.json:3: /pipelines/0/names: found without \"from\", allowed: beside the scenario "
            "that it chooses from");
  EXPECT_THAT(error(R"({"from": "leaderbord_lan"})"),
              testing::StartsWith("my.json:3: /pipelines/0/from: found \"leaderbord_lan\", did you "
                                  "mean leaderboard_lan"));
  EXPECT_THAT(error(R"({"from": "leaderboard_lan", "gatherng": "k4a"})"),
              testing::HasSubstr("gatherng"));
}

// As an editor does that reads "$schema".
TEST(IncludedPipelines, TheSchemaTakesSimbenchsOwnFilesAsTheyAreWritten) {
  const JsonSchema schema(nlohmann::json::parse(schema_text()));
  for (const BuiltinFile& file : nonempty(builtin_files())) {
    for (const SchemaProblem& problem : schema.problems(nlohmann::json::parse(file.text))) {
      ADD_FAILURE() << file.name << problem.pointer << ": " << problem.text;
    }
  }
}

TEST(IncludedPipelines, CirclesEnd) {
  const ScratchFolder folder;
  const auto taking = [](const std::string& from) {
    return "{\"base\": \"18cam_6host_45fps\", \"name\": \"my\", \"summary\": \"s\", "
           "\"pipelines\": [{\"from\": \"" +
           from + "\"}]}";
  };
  const std::string one = folder.write("one.json", taking("two.json"));
  const std::string two = folder.write("two.json", taking("one.json"));
  try {
    load_scenario(one);
    FAIL() << "a circle was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), two + ":1: /pipelines/0/from: found a circle of bases: " + one +
                                " -> " + two + " -> " + one);
  }
}

}  // namespace
}  // namespace simbench::scenarios
