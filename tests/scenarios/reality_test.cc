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

}  // namespace
}  // namespace simbench::scenarios
