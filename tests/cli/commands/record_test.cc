// `simbench record`, and `simbench replay` of what it wrote, through the real program.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class RecordCommand : public ProgramTest {
 protected:
  // The small scenario with one pipeline and few frames.
  ProgramResult record_small(const std::vector<std::string>& more = {},
                             const ProgramOptions& options = {}) const {
    std::vector<std::string> all = {"record",
                                    "--scenario",
                                    "3cam_1host_30fps",
                                    "--set",
                                    "/timeline/frames=30",
                                    "--pipelines",
                                    "oracle",
                                    "-o",
                                    "rec"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all, options);
  }

  // Everything of a result but what its making cost.
  static Json without_performance(const std::string& text) {
    Json root = Json::parse(text);
    root.erase("performance");
    return root;
  }

  // Holds the replay of a recording to the run that it records, byte for byte.
  void expect_replay_equals_run(const std::vector<std::string>& choice) const {
    SCOPED_TRACE(choice.at(1));
    std::vector<std::string> run_it = {"run", "--seeds",  "1",    "--first-seed",
                                       "5",   "--format", "json", "--no-levers"};
    std::vector<std::string> record_it = {"record", "--seed", "5", "-o", "rec"};
    run_it.insert(run_it.end(), choice.begin(), choice.end());
    record_it.insert(record_it.end(), choice.begin(), choice.end());
    const ProgramResult ran = run(run_it);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const ProgramResult recorded = run(record_it);
    ASSERT_EQ(recorded.status, 0) << recorded.err;
    const ProgramResult replayed = run({"replay", "rec", "--format", "json"});
    ASSERT_EQ(replayed.status, 0) << replayed.err;
    EXPECT_EQ(without_performance(replayed.out).dump(1), without_performance(ran.out).dump(1));
    EXPECT_THAT(replayed.err, Not(HasSubstr("note:")));
    std::filesystem::remove_all(folder() / "rec");
  }
};

TEST_F(RecordCommand, AReplayGivesTheNumbersOfTheRun) {
  expect_replay_equals_run({"--scenario", "3cam_1host_30fps"});
  expect_replay_equals_run({"--scenario", "6cam_2host_30fps"});
}

TEST_F(RecordCommand, AReplayOfAGenlockRigGivesTheNumbersOfTheRun) {
  expect_replay_equals_run({"--scenario", "18cam_6host_45fps", "--set", "/timeline/frames=40",
                            "--pipelines", "oracle,yoon2021_both"});
}

TEST_F(RecordCommand, AReplayHasTheSightingsOfAnLedClock) {
  expect_replay_equals_run({"--scenario", "25cam_led_30fps", "--set", "/timeline/frames=40",
                            "--pipelines", "rocsync_led.hardware_sync"});
}

// Without polls, two_way_poll would be the bare arrivals.
TEST_F(RecordCommand, ARecordingWithoutPollsHasNoNumbersOfAPipelineThatNeedsThem) {
  const ProgramResult recorded =
      run({"record", "--scenario", "18cam_6host_45fps_lan", "--set", "/timeline/frames=40",
           "--pipelines", "best_online_oracle_hosts,genlock", "-o", "rec"});
  ASSERT_EQ(recorded.status, 0) << recorded.err;
  Json manifest = Json::parse(content("rec/manifest.json"));
  for (Json& capture : manifest["captures"]) {
    capture["complete"] = false;  // so that lines may be missing
    const std::string events = "rec/" + capture["pipeline"].get<std::string>() + "/1/events.csv";
    std::istringstream lines(content(events));
    std::string kept;
    for (std::string line; std::getline(lines, line);) {
      if (line.find(",poll,") == std::string::npos) kept += line + "\n";
    }
    file(events, kept);
  }
  file("rec/manifest.json", manifest.dump());
  const ProgramResult replayed = run({"replay", "rec", "--format", "json"});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_THAT(replayed.err, HasSubstr("seed 1: two_way_poll needs polls of the cameras' clocks"));
  const Json root = Json::parse(replayed.out);
  for (const Json& row : root["rows"]) {
    EXPECT_EQ(row["amd_ms"]["median"].is_null(), row["pipeline"] != "genlock") << row["pipeline"];
  }
  EXPECT_EQ(root["rows"].size(), 2U);
}

TEST_F(RecordCommand, AReplayOfARigWithFaultsGivesTheNumbersOfTheRun) {
  expect_replay_equals_run({"--scenario", "18cam_6host_45fps_frame_drops_10pct", "--set",
                            "/timeline/frames=40", "--pipelines", "yoon2021_both"});
  expect_replay_equals_run({"--scenario", "18cam_6host_45fps_clock_step_during_capture", "--set",
                            "/timeline/frames=40", "--pipelines", "yoon2021_both"});
}

TEST_F(RecordCommand, TheTableIsThatOfTheRun) {
  ASSERT_EQ(record_small().status, 0);
  const std::vector<std::string> one_run = {
      "run",         "--scenario", "3cam_1host_30fps", "--set", "/timeline/frames=30",
      "--pipelines", "oracle",     "--seeds",          "1",     "--format",
      "csv"};
  EXPECT_EQ(run({"replay", "rec", "--format", "csv"}).out, run(one_run).out);
  EXPECT_THAT(run({"replay", "rec/"}).out, HasSubstr("oracle"));
  EXPECT_THAT(run({"replay", "rec", "--format", "markdown"}).out, HasSubstr("| oracle"));
}

TEST_F(RecordCommand, TheFolderIsAsDocumented) {
  const ProgramResult result = record_small();
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("note: 1 of 1 capture recorded in rec"));
  EXPECT_THAT(names_in("rec"), ElementsAre("manifest.json", "oracle"));
  EXPECT_THAT(names_in("rec/oracle/1"), ElementsAre("events.csv", "frames.csv"));
  EXPECT_THAT(content("rec/oracle/1/frames.csv"), StartsWith("order,camera,stream,domain,"));
  const Json manifest = Json::parse(content("rec/manifest.json"));
  EXPECT_EQ(manifest["format"], "simbench recording");
  EXPECT_EQ(manifest["backend"], "sim");
  EXPECT_EQ(manifest["scenario"]["timeline"]["frames"], 30);
  EXPECT_EQ(manifest["captures"][0]["complete"], true);
}

TEST_F(RecordCommand, EqualCommandsWriteEqualBytes) {
  ASSERT_EQ(record_small().status, 0);
  std::filesystem::rename(folder() / "rec", folder() / "first");
  ASSERT_EQ(record_small().status, 0);
  for (const std::string name : {"manifest.json", "oracle/1/frames.csv", "oracle/1/events.csv"}) {
    EXPECT_EQ(content("rec/" + name), content("first/" + name)) << name;
  }
}

TEST_F(RecordCommand, NeverOverwrites) {
  ASSERT_EQ(record_small().status, 0);
  const ProgramResult again = record_small();
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("rec: is not empty; a recording needs a new folder"));
}

TEST_F(RecordCommand, AFullDiskIsAClearErrorAndTheRestIsReplayed) {
  ProgramOptions full_disk;
  full_disk.largest_file = 40'000;
  const ProgramResult result = record_small({}, full_disk);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("error: rec/oracle/1/frames.csv: cannot be written: "));
  const ProgramResult replayed = run({"replay", "rec"});
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_THAT(replayed.err, HasSubstr("note: pipeline oracle, seed 1: the recording has no end"));
}

TEST_F(RecordCommand, CtrlCKeepsWhatWasRecorded) {
  const ProgramResult result =
      run({"record", "--scenario", "18cam_6host_45fps", "--set", "/timeline/frames=500000",
           "--pipelines", "genlock,oracle", "-o", "rec"},
          {.interrupt_after = std::chrono::milliseconds(0),
           .interrupt_once_written = "rec/genlock/1/frames.csv"});
  EXPECT_EQ(result.status, 130);
  EXPECT_THAT(result.err, HasSubstr("interrupted after 0 of 2 captures; rec holds what was "));
  const Json capture = Json::parse(content("rec/manifest.json"))["captures"][0];
  EXPECT_EQ(capture["complete"], false);
  EXPECT_EQ(capture["notes"][0], "interrupted");
  EXPECT_EQ(content("rec/genlock/1/frames.csv").back(), '\n');
  const ProgramResult replayed = run({"replay", "rec"});
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_THAT(replayed.err, HasSubstr("note: pipeline oracle: 1 of 1 capture not recorded"));
}

TEST_F(RecordCommand, ADamagedRecordingIsReplayedUpToTheDamage) {
  ASSERT_EQ(record_small().status, 0);
  std::string frames = content("rec/oracle/1/frames.csv");
  frames[frames.find('\n', frames.size() / 2) + 1] = 'x';
  file("rec/oracle/1/frames.csv", frames);
  const ProgramResult replayed = run({"replay", "rec"});
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_THAT(replayed.err, HasSubstr("note: pipeline oracle, seed 1: damaged, played up to there: "
                                      "rec/oracle/1/frames.csv:"));
  EXPECT_THAT(replayed.err, HasSubstr("column 1 (order): found 'x"));
}

TEST_F(RecordCommand, ADamagedManifestIsAClearError) {
  ASSERT_EQ(record_small().status, 0);
  file("rec/manifest.json", content("rec/manifest.json").substr(0, 300));
  const ProgramResult replayed = run({"replay", "rec"});
  EXPECT_EQ(replayed.status, 2);
  EXPECT_THAT(replayed.err, HasSubstr("error: rec/manifest.json: parse error at line"));
}

TEST_F(RecordCommand, PipelinesAndArchiveAsInARun) {
  ASSERT_EQ(run({"record", "--scenario", "3cam_1host_30fps", "--set", "/timeline/frames=30",
                 "--pipelines", "oracle,free_running", "-o", "rec"})
                .status,
            0);
  const ProgramResult one =
      run({"replay", "rec", "--pipelines", "free_running", "--output", "res", "--json"});
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(Json::parse(one.out)["rows"].size(), 1U);
  EXPECT_THAT(names_in("res"),
              ElementsAre("frames.csv", "hosts.csv", "manifest.json", "results.json"));
  const ProgramResult other = run({"replay", "rec", "--pipelines", "genlock"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err,
              HasSubstr("--pipelines: found 'genlock', recorded in rec: oracle, free_running"));
}

TEST_F(RecordCommand, FolderAndFilesAreNotMixed) {
  ASSERT_EQ(record_small().status, 0);
  const ProgramResult mixed = run({"replay", file("a.csv", ""), "rec"});
  EXPECT_EQ(mixed.status, 2);
  EXPECT_THAT(mixed.err,
              HasSubstr("rec: found among 2 inputs, allowed one recording folder, or files"));
  std::filesystem::create_directory(folder() / "empty");
  const ProgramResult other = run({"replay", "empty"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("empty: is no recording, it has no manifest.json"));
}

}  // namespace
}  // namespace simbench
