#include "scenarios/reality.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/builtin_files.h"
#include "scenarios/loader.h"
#include "scenarios/schema.h"
#include "tests/nonempty.h"

namespace simbench::scenarios {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Reality, EveryFileIsWhatTheSchemaSays) {
  const JsonSchema schema(nlohmann::json::parse(recording_schema_text()));
  for (const BuiltinFile& file : nonempty(recording_files())) {
    EXPECT_TRUE(schema.problems(nlohmann::json::parse(file.text)).empty()) << file.name;
  }
  auto wrong = nlohmann::json::parse(recording_files().front().text);
  wrong["settings"][0]["quantity"] = "mean";
  EXPECT_FALSE(schema.problems(wrong).empty());
}

TEST(Reality, EverySettingIsOfAScenarioWithThatPipelineAndHost) {
  for (const RealRecording& recording : nonempty(real_recordings())) {
    for (const RealitySetting& setting : nonempty(recording.settings)) {
      SCOPED_TRACE(recording.name + ": " + setting.name);
      const Scenario scenario = load_scenario(setting.scenario, setting.set);
      EXPECT_EQ(std::ranges::count(scenario.pipelines, setting.pipeline, &Pipeline::name), 1);
      EXPECT_LT(static_cast<std::int64_t>(setting.host), scenario.hosts.count);
    }
  }
}

TEST(Reality, EveryUnknownParameterIsAPlaceOfOneOfTheScenarios) {
  for (const RealRecording& recording : nonempty(real_recordings())) {
    for (const UnknownParameter& unknown : recording.unknown) {
      if (unknown.pointer.starts_with("/algorithms/")) continue;
      const bool is_known =
          std::ranges::any_of(recording.settings, [&](const RealitySetting& setting) {
            const std::vector<ParameterLine> lines =
                describe(load_scenario(setting.scenario, setting.set));
            return std::ranges::any_of(lines, [&](const ParameterLine& line) {
              return line.pointer == unknown.pointer ||
                     line.pointer.starts_with(unknown.pointer + '/');
            });
          });
      EXPECT_TRUE(is_known) << recording.name << ": " << unknown.pointer;
    }
  }
}

TEST(Reality, ALoadedScenarioSaysHowFarOffTheBenchWas) {
  EXPECT_TRUE(load_reality(load_scenario("4host_chain_idle")).empty());
  EXPECT_THAT(load_reality(load_scenario("4host_chain_tcp")),
              ElementsAre(AllOf(StartsWith("within a factor of 1.2 (1 hop), "),
                                HasSubstr("(3 hops) of real rigs under saturating TCP "
                                          "(chrony_chain; figures that were known"))));
  const Override traffic{.pointer = "/network/traffic",
                         .value = R"([{"kind": "tcp", "from": 0, "to": 1},
                                      {"kind": "random", "from": 0, "to": 1, "mbit_per_s": 100}])"};
  EXPECT_THAT(load_reality(load_scenario("6host_star",
                                         {traffic, {"/network/bandwidth_mbit_per_s", "1000"}})),
              ElementsAre(StartsWith("within a factor of 1.2 of real rigs under saturating TCP"),
                          "no real rig was measured under random traffic"));
  EXPECT_THAT(load_reality(load_scenario("6host_star",
                                         {{"/hosts/steal", R"({"share": 0.1, "slice_ms": 4})"}})),
              ElementsAre("no real rig was measured under stolen processors"));
}

}  // namespace
}  // namespace simbench::scenarios
