// `simbench replay` and `simbench convert-ibl` through the real program.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/commands/rs_csv_files.h"
#include "tests/cli/program.h"
#include "tests/data/ibl_recordings.h"
#include "tests/data/test_data.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
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
  EXPECT_THAT(markdown.err, HasSubstr("--format: found 'markdown', allowed with files: "));
  const ProgramResult pipelines = run({"replay", name, "--pipelines", "oracle"});
  EXPECT_EQ(pipelines.status, 2);
  EXPECT_THAT(pipelines.err, HasSubstr("--pipelines: only a recording folder has pipelines"));
}

TEST_F(ReplayCommand, RecordingsOfOneNameAreTwoCameras) {
  for (const char* name : {"front", "back"}) std::filesystem::create_directory(folder() / name);
  file("front/cam.csv", recording(0));
  file("back/cam.csv", recording(2));
  const ProgramResult result = run({"replay", "front/cam.csv", "back/cam.csv", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  ASSERT_EQ(root["cameras"].size(), 2U);
  EXPECT_EQ(root["cameras"][0]["camera"], "front/cam");
  EXPECT_EQ(root["cameras"][1]["camera"], "back/cam");
}

TEST_F(ReplayCommand, WhatNeedsPollsSaysSo) {
  const ProgramResult result = run({"replay", file("a.csv", recording(0)), "--output", "results"});
  EXPECT_THAT(result.out, testing::ContainsRegex("two_way_poll +needs polls +- +- +- +- +-"));
  EXPECT_THAT(result.out, testing::ContainsRegex("librealsense_global +needs polls +-"));
  std::istringstream frames(content("results/frames.csv"));
  std::string header;
  std::string line;
  std::getline(frames, header);
  std::getline(frames, line);
  std::istringstream names(header);
  std::istringstream cells(line + ",");
  std::string name;
  std::string cell;
  while (std::getline(names, name, ',')) {
    std::getline(cells, cell, ',');
    const bool polls = name == "global_ms_two_way_poll" || name == "global_ms_librealsense_global";
    EXPECT_EQ(cell.empty(), polls) << name;
  }
}

TEST_F(ReplayCommand, OneOrTwoFramesHaveNoNan) {
  file("one.csv", kHeader + "Depth,0,1,10,100\n");
  file("two.csv", kHeader + "Depth,0,1,10,100\nDepth,0,2,43,133\n");
  for (const std::vector<std::string>& files :
       {std::vector<std::string>{"one.csv"}, {"two.csv"}, {"one.csv", "two.csv"}}) {
    for (const char* format : {"table", "json", "csv"}) {
      std::vector<std::string> arguments = {"replay", "--format", format};
      arguments.insert(arguments.end(), files.begin(), files.end());
      const ProgramResult result = run(arguments);
      EXPECT_EQ(result.status, 0) << result.err;
      EXPECT_THAT(result.out, Not(testing::ContainsRegex("(nan|inf)\\b"))) << files[0] << format;
    }
  }
}

TEST_F(ReplayCommand, DoubtfulNumbersHaveAWarning) {
  std::string microseconds = kHeader;
  for (int i = 0; i < 100; ++i)
    microseconds += fmt::format("Depth,0,{},{},{}\n", i, i * 33000, i * 33);
  const ProgramResult result = run({"replay", file("us.csv", microseconds)});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("warning: us Depth 0: a drift of -999000 ppm is no camera's"));
  const ProgramResult cut = run({"replay", file("cut.csv", recording(0) + "Depth,0,9,12")});
  EXPECT_EQ(cut.status, 0);
  EXPECT_THAT(cut.err, HasSubstr("note: cut.csv:202: the last line has no line end"));
}

TEST_F(ReplayCommand, WhatIsNoRecordingIsOneLineAtOnce) {
  for (const char* name : {"/dev/zero", "/dev/full", "/proc/self/mem"}) {
    for (const char* command : {"replay", "diagnose"}) {
      const ProgramResult result = run({command, name});
      EXPECT_EQ(result.status, 2) << name;
      EXPECT_THAT(result.err, StartsWith(fmt::format("error: {}: cannot be read: ", name)));
    }
  }
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"compare", "/dev/zero", "/dev/zero"},
        {"gate", "/dev/zero", "--baseline", "/dev/zero"},
        {"report", "/dev/zero", "-o", "page.html"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments[0];
    EXPECT_THAT(result.err, HasSubstr("/dev/zero")) << arguments[0];
  }
}

TEST_F(ReplayCommand, EscapesInNamesAreShown) {
  const std::string text = "camera,host," + kHeader +
                           "\x1b[31mred,\x1b]0;h\x07,Depth,0,1,10,100\n"
                           "\x1b[31mred,\x1b]0;h\x07,Depth,0,2,43,133\n";
  file("esc.csv", text);
  file("\x1b[2J.csv", kHeader + "Depth,0,1,10,100\n");
  for (const char* command : {"replay", "diagnose"}) {
    const ProgramResult result = run({command, "esc.csv", "\x1b[2J.csv"});
    EXPECT_EQ(result.status, 0);
    EXPECT_THAT(result.out, HasSubstr("\\x1b[31mred"));
    EXPECT_THAT(result.out + result.err, Not(HasSubstr("\x1b")));
    EXPECT_THAT(result.out, Not(HasSubstr("\x07")));
  }
  EXPECT_THAT(run({"replay", "\x1b[2Jnone.csv"}).err, Not(HasSubstr("\x1b")));
}

TEST_F(ReplayCommand, ALongRecordingShowsProgressAndHearsCtrlC) {
  std::string text = kHeader;
  for (int i = 0; i < 400'000; ++i)
    text += fmt::format("Depth,0,{},{}.25,{}.5\n", i, i * 33, i * 33);
  const std::string name = file("long.csv", text);
  const ProgramResult stopped = run({"replay", name, "--output", "results"},
                                    {.interrupt_after = std::chrono::milliseconds(1)});
  EXPECT_EQ(stopped.status, 130);
  EXPECT_THAT(stopped.err, HasSubstr("interrupted after "));
  EXPECT_THAT(names_in(), ElementsAre("long.csv"));
  const ProgramResult whole = run({"replay", name});
  EXPECT_EQ(whole.status, 0);
  EXPECT_THAT(whole.err, HasSubstr(" of 6800000 stamps ("));
}

// `simbench replay` of a recording that is converted: the drift by least squares and by the
// envelope.
std::pair<double, double> drifts_ppm(const ProgramResult& replayed) {
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  const Json camera = Json::parse(replayed.out)["cameras"][0];
  return {camera["drift_ppm"].get<double>(), camera["envelope_drift_ppm"].get<double>()};
}

TEST_F(ReplayCommand, AnIblRecordingIsConvertedAndReplayed) {
  const ProgramResult converted =
      run({"convert-ibl", file("a.timestamps.ssv", ibl_timestamps({.drift_ppm = 60}))});
  ASSERT_EQ(converted.status, 0) << converted.err;
  const auto [drift, envelope] =
      drifts_ppm(run({"replay", file("body.csv", converted.out), "--format", "json"}));
  EXPECT_NEAR(drift, 60, 0.18);
  EXPECT_NEAR(envelope, 60, 0.01);
}

TEST_F(ReplayCommand, ARealRecordingIsConvertedAndReplayed) {
  SIMBENCH_SKIP_WITHOUT(kRealBody);
  const ProgramResult converted = run({"convert-ibl", kRealBody});
  ASSERT_EQ(converted.status, 0) << converted.err;
  const auto [drift, envelope] =
      drifts_ppm(run({"replay", file("body.csv", converted.out), "--format", "json"}));
  EXPECT_NEAR(drift, -215.385, 0.0005);
  EXPECT_NEAR(envelope, -214.932, 0.0005);
}

}  // namespace
}  // namespace simbench
