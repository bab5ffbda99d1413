// `simbench replay` and `simbench convert-ibl` through the real program.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/cli/commands/rs_csv_files.h"
#include "tests/cli/program.h"
#include "tests/data/test_data.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class ReplayCommand : public ProgramTest {
 protected:
  // 200 frames at 45 FPS; the camera's clock is 100 ppm fast, arrivals are `late_ms` late.
  static std::string recording(double late_ms) {
    std::string text = kHeader;
    for (int i = 0; i < 200; ++i) {
      const double ms = i * 1000.0 / 45;
      text += fmt::format("Depth,0,{},{:.3f},{:.6f}\n", i + 1, 700 + ms * 1.0001, ms + late_ms);
    }
    return text;
  }
};

TEST_F(ReplayCommand, PrintsDriftAndSaysWhatCannotBeReplayed) {
  const ProgramResult result = run({"replay", file("a.csv", recording(0))});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("regression_30"));
  EXPECT_THAT(result.out, HasSubstr("-99.9"));
  EXPECT_THAT(result.err, HasSubstr("host_sync cannot be replayed"));
}

TEST_F(ReplayCommand, JsonIsAllThatIsOnStandardOutput) {
  const ProgramResult result =
      run({"replay", file("a.csv", recording(0)), file("b.csv", recording(2)), "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["schema_version"], 1);
  EXPECT_EQ(root["cameras"].size(), 2U);
  EXPECT_NEAR(root["cameras"][0]["drift_ppm"].get<double>(), -99.99, 0.1);
  EXPECT_EQ(root["rows"][0]["device_time"], "regression_30");
  EXPECT_EQ(root["rigs"][0]["verified"], false);
  EXPECT_NEAR(root["rigs"][0]["rows"][0]["amd_ms"].get<double>(), 2, 0.01);
}

TEST_F(ReplayCommand, OutputHasALinePerFrame) {
  const ProgramResult result =
      run({"replay", file("a.csv", recording(0)), "--output", "results", "--format", "csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("camera,stream,device_time,jitter_ms,"));
  EXPECT_THAT(names_in("results"), ElementsAre("frames.csv", "manifest.json", "results.json"));
  std::istringstream frames(content("results/frames.csv"));
  std::string line;
  std::getline(frames, line);
  EXPECT_THAT(line, StartsWith("camera,frame,sensor_ms,arrival_ms,global_ms_regression_30,"
                               "global_ms_regression_offline,global_ms_eq1_printed,"));
  EXPECT_THAT(line, HasSubstr(",global_ms_raw_arrival"));
  std::getline(frames, line);
  EXPECT_THAT(line, StartsWith("a,1,700.000000,0.000000,0.000000,"));
  int count = 1;
  while (std::getline(frames, line)) ++count;
  EXPECT_EQ(count, 200);
}

TEST_F(ReplayCommand, EqualCommandsGiveEqualBytes) {
  file("a.csv", recording(0));
  const ProgramResult once = run({"replay", "a.csv", "--format", "json"});
  EXPECT_EQ(once.out, run({"replay", "a.csv", "--format", "json"}).out);
}

TEST_F(ReplayCommand, WhatOnlyAFolderTakesIsRefusedForFiles) {
  const std::string name = file("a.csv", recording(0));
  const ProgramResult markdown = run({"replay", name, "--format", "markdown"});
  EXPECT_EQ(markdown.status, 2);
  EXPECT_THAT(markdown.err, HasSubstr("--format: found 'markdown', allowed with CSV files: "));
  const ProgramResult pipelines = run({"replay", name, "--pipelines", "oracle"});
  EXPECT_EQ(pipelines.status, 2);
  EXPECT_THAT(pipelines.err, HasSubstr("--pipelines: only a recording folder has pipelines"));
}

TEST_F(ReplayCommand, ARealRecordingIsConvertedAndReplayed) {
  const ProgramResult converted = run({"convert-ibl", kBody});
  ASSERT_EQ(converted.status, 0) << converted.err;
  const ProgramResult result = run({"replay", file("body.csv", converted.out), "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_NEAR(root["cameras"][0]["drift_ppm"].get<double>(), -215.385, 0.0005);
  EXPECT_NEAR(root["cameras"][0]["envelope_drift_ppm"].get<double>(), -214.932, 0.0005);
}

}  // namespace
}  // namespace simbench
