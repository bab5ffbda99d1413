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

TEST_F(ReplayCommand, PrintsARowForEachDeviceTimeAndSaysWhatCannotBeReplayed) {
  const ProgramResult result =
      run({"replay", file("a.csv", recording(0)), file("b.csv", recording(2))});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("regression_30"));
  EXPECT_THAT(result.out, HasSubstr("unverified"));
  EXPECT_THAT(result.out, HasSubstr("Frames, from the first to the last"));
  EXPECT_THAT(result.err, HasSubstr("host_sync cannot be replayed"));
}

TEST_F(ReplayCommand, JsonIsThatOfARunAndAllThatIsOnStandardOutput) {
  const ProgramResult result =
      run({"replay", file("a.csv", recording(0)), file("b.csv", recording(2)), "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["scenario"], "a.csv and 1 more");
  const Json& row = root["rows"][0];
  EXPECT_EQ(row["pipeline"], "regression_30");
  EXPECT_EQ(row["ground_truth"], "none");
  EXPECT_EQ(row["frames"]["delivered"], 400);
  EXPECT_NEAR(row["amd_ms"]["median"].get<double>(), 2, 0.01);
  EXPECT_TRUE(row["gathering_score"]["precision"].is_null());
}

TEST_F(ReplayCommand, EveryFormatShowsThePipelinesThatWereAsked) {
  file("a.csv", recording(0));
  file("b.csv", recording(2));
  for (const char* format : {"table", "markdown", "latex", "json", "csv", "tidy"}) {
    const ProgramResult result = run({"replay", "a.csv", "b.csv", "--pipelines",
                                      "hull_300,raw_arrival+genlock", "--format", format});
    EXPECT_EQ(result.status, 0) << format << result.err;
    EXPECT_THAT(result.out, HasSubstr("hull")) << format;
    EXPECT_THAT(result.out, Not(HasSubstr("theil"))) << format;
  }
  EXPECT_THAT(
      run({"replay", "a.csv", "b.csv", "--pipelines", "hull_300", "--format", "markdown"}).out,
      HasSubstr("| hull_300"));
}

TEST_F(ReplayCommand, WhatIsKnownOfTheFilesCanBeStated) {
  file("a.csv", recording(0));
  file("b.csv", recording(2));
  const Json root = Json::parse(run({"replay", "a.csv", "b.csv", "--genlock", "--pipelines",
                                     "raw_arrival", "--format", "json"})
                                    .out);
  EXPECT_EQ(root["rows"][0]["ground_truth"], "genlock_order");
  EXPECT_EQ(root["rows"][0]["gathering_score"]["precision"], 1);
  const ProgramResult stream = run({"replay", "a.csv", "--stream", "Color 0"});
  EXPECT_EQ(stream.status, 2);
  EXPECT_THAT(stream.err, HasSubstr("--stream: found 'Color 0', allowed Depth 0"));
  const ProgramResult parts = run({"replay", "a.csv", "--pipelines", "chrony+hull_300+yoon2021"});
  EXPECT_EQ(parts.status, 2);
  EXPECT_THAT(parts.err, HasSubstr("allowed of files: device_time[+gathering]"));
}

// An archive of files is reported, compared and gated as one of a run.
TEST_F(ReplayCommand, AnArchiveOfFilesGoesWhereThatOfARunGoes) {
  file("a.csv", recording(0));
  file("b.csv", recording(2));
  file("c.csv", recording(3));
  const auto archive = [&](const std::string& second, const std::string& folder) {
    const ProgramResult made =
        run({"replay", "a.csv", second, "--pipelines", "hull_300,raw_arrival", "--output", folder});
    ASSERT_EQ(made.status, 0) << made.err;
  };
  archive("b.csv", "monday");
  archive("b.csv", "again");
  archive("c.csv", "other");
  EXPECT_THAT(names_in("monday"),
              ElementsAre("frames.csv", "hosts.csv", "manifest.json", "results.json"));

  const ProgramResult report = run({"report", "monday", "-o", "page.html"});
  EXPECT_EQ(report.status, 0) << report.err;
  EXPECT_THAT(content("page.html"), HasSubstr("raw_arrival"));
  EXPECT_THAT(content("page.html"), HasSubstr("whose capture cannot be simulated"));

  const ProgramResult compared = run({"compare", "monday", "again"});
  EXPECT_EQ(compared.status, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("hull_300"));
  const ProgramResult different = run({"compare", "monday", "other"});
  EXPECT_EQ(different.status, 2);
  EXPECT_THAT(different.err, HasSubstr("/recording/files/1"));
  EXPECT_EQ(run({"compare", "monday", "other", "--different-scenarios"}).status, 0);

  EXPECT_EQ(run({"gate", "monday", "--save-baseline", "kept.json"}).status, 0);
  const ProgramResult passed = run({"gate", "again", "--baseline", "kept.json"});
  EXPECT_EQ(passed.status, 0) << passed.out << passed.err;
  EXPECT_EQ(run({"gate", "other", "--baseline", "kept.json"}).status, 2);
}

TEST_F(ReplayCommand, FiguresAreDrawnFromFiles) {
  file("a.csv", recording(0));
  const ProgramResult drawn =
      run({"figure", "stamp_intervals", "a.csv", "--pipelines", "hull_300", "-o", "f.csv"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_THAT(content("f.csv"), StartsWith("panel,series,x,y"));
}

TEST_F(ReplayCommand, EqualCommandsGiveEqualBytes) {
  file("a.csv", recording(0));
  const auto result = [&] {
    Json root = Json::parse(run({"replay", "a.csv", "--format", "json"}).out);
    EXPECT_EQ(root.erase("performance"), 1U);
    return root.dump();
  };
  EXPECT_EQ(result(), result());
  const auto table = [&] { return run({"replay", "a.csv", "--quiet"}).out; };
  EXPECT_EQ(table(), table());
}

TEST_F(ReplayCommand, RecordingsOfOneNameAreTwoCameras) {
  for (const char* name : {"front", "back"}) std::filesystem::create_directory(folder() / name);
  file("front/cam.csv", recording(0));
  file("back/cam.csv", recording(2));
  const ProgramResult result = run({"replay", "front/cam.csv", "back/cam.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("front/cam"));
  EXPECT_THAT(result.out, HasSubstr("back/cam"));
}

TEST_F(ReplayCommand, WhatTheFilesLackIsSaidByTheRow) {
  const ProgramResult result =
      run({"replay", file("a.csv", recording(0)), file("b.csv", recording(2)), "--pipelines",
           "two_way_poll,raw_arrival", "--format", "json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("pipeline two_way_poll, seed 1: two_way_poll needs polls of "
                                    "the cameras' clocks, and none was recorded"));
  const Json rows = Json::parse(result.out)["rows"];
  EXPECT_TRUE(rows[0]["amd_ms"]["median"].is_null());
  EXPECT_NEAR(rows[1]["amd_ms"]["median"].get<double>(), 2, 1e-3);
}

TEST_F(ReplayCommand, StampsOfEveryFrameAreExported) {
  const ProgramResult result = run({"export", file("a.csv", recording(0)), "--stamps",
                                    "regression_30,raw_arrival", "-o", "frames.csv"});
  ASSERT_EQ(result.status, 0) << result.err;
  std::istringstream frames(content("frames.csv"));
  std::string line;
  std::getline(frames, line);
  EXPECT_EQ(line,
            "camera,stream,frame,sensor_ms,arrival_ms,global_ms_regression_30,"
            "global_ms_raw_arrival");
  std::getline(frames, line);
  EXPECT_EQ(line, "a,Depth 0,1,700.000000,0.000000,0.000000,0.000000");
  int count = 1;
  while (std::getline(frames, line)) ++count;
  EXPECT_EQ(count, 200);
  const ProgramResult refused = run({"export", "a.csv", "--stamps", "two_way_poll"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("--stamps: found 'two_way_poll', allowed: regression_30"));
}

TEST_F(ReplayCommand, InspectHasTheClocksAndTheStamps) {
  const ProgramResult result = run({"inspect", file("a.csv", recording(0)), "--device-times",
                                    "raw_arrival", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json found = Json::parse(result.out)["files"][0];
  EXPECT_NEAR(found["streams"][0]["clocks"]["drift_ppm"].get<double>(), -99.99, 0.1);
  EXPECT_EQ(found["stamps"][0]["device_time"], "raw_arrival");
  EXPECT_NEAR(found["stamps"][0]["drift_ppm"].get<double>(), -99.99, 0.1);
  EXPECT_THAT(run({"inspect", "a.csv"}).out, HasSubstr("-99.9"));
}

TEST_F(ReplayCommand, OneOrTwoFramesHaveNoNan) {
  file("one.csv", kHeader + "Depth,0,1,10,100\n");
  file("two.csv", kHeader + "Depth,0,1,10,100\nDepth,0,2,43,133\n");
  for (const std::vector<std::string>& files :
       {std::vector<std::string>{"one.csv"}, {"two.csv"}, {"one.csv", "two.csv"}}) {
    for (const char* format : {"table", "json", "csv", "markdown"}) {
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

TEST_F(ReplayCommand, ALongRecordingHearsCtrlC) {
  std::string text = kHeader;
  for (int i = 0; i < 400'000; ++i)
    text += fmt::format("Depth,0,{},{}.25,{}.5\n", i, i * 33, i * 33);
  const std::string name = file("long.csv", text);
  const ProgramResult stopped = run({"replay", name, "--output", "results"},
                                    {.interrupt_after = std::chrono::milliseconds(1)});
  EXPECT_EQ(stopped.status, 130);
  EXPECT_THAT(stopped.err, HasSubstr("interrupted after "));
  EXPECT_THAT(names_in(), ElementsAre("long.csv"));
}

// The drift of a file's first stream, by least squares and by the envelope.
std::pair<double, double> drifts_ppm(const ProgramResult& inspected) {
  EXPECT_EQ(inspected.status, 0) << inspected.err;
  const Json clocks = Json::parse(inspected.out)["files"][0]["streams"][0]["clocks"];
  return {clocks["drift_ppm"].get<double>(), clocks["envelope_drift_ppm"].get<double>()};
}

TEST_F(ReplayCommand, AnIblRecordingIsReadAsItIsAndConverted) {
  const std::string made = file("a.timestamps.ssv", ibl_timestamps({.drift_ppm = 60}));
  const ProgramResult converted = run({"convert-ibl", made});
  ASSERT_EQ(converted.status, 0) << converted.err;
  for (const std::string& input : {made, file("body.csv", converted.out)}) {
    const auto [drift, envelope] = drifts_ppm(run({"inspect", input, "--format", "json"}));
    EXPECT_NEAR(drift, 60, 0.18);
    EXPECT_NEAR(envelope, 60, 0.01);
    EXPECT_EQ(run({"replay", input, "--pipelines", "hull_300"}).status, 0) << input;
  }
}

TEST_F(ReplayCommand, ARealRecordingIsConvertedAndInspected) {
  SIMBENCH_SKIP_WITHOUT(kRealBody);
  const ProgramResult converted = run({"convert-ibl", kRealBody});
  ASSERT_EQ(converted.status, 0) << converted.err;
  const auto [drift, envelope] =
      drifts_ppm(run({"inspect", file("body.csv", converted.out), "--format", "json"}));
  EXPECT_NEAR(drift, -215.385, 0.0005);
  EXPECT_NEAR(envelope, -214.932, 0.0005);
}

}  // namespace
}  // namespace simbench
