// Pipelines of real programs through the real command line: --program and --program-log.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "tests/cli/program.h"

namespace simbench {
namespace {

using Json = nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ProgramsCommand : public ProgramTest {
 protected:
  // Ten minutes of three hosts: chrony's model, and the programs of this file.
  ProgramResult clocks(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "clocks", "--scenario",       "6host_star",  "--set", "/hosts/count=3",
        "--set",  "/cameras/count=3", "--seeds",     "1",     "--duration-s",
        "310",    "--pipelines",      "free_running"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  void write(const std::string& name, const Json& program) const {
    file(name, Json{{"host_sync", {{"program", program}}}}.dump());
  }
  // What the row of a command says of it.
  std::string said_of(const std::string& word) const {
    write("one.json", {{"master", Json::array({Json::array({"/bin/true"})})},
                       {"slave", Json::array({Json::array({word})})}});
    const ProgramResult result = clocks({"--program", "one=one.json"});
    EXPECT_EQ(result.status, 5) << "it failed in every seed";
    EXPECT_THAT(result.out, HasSubstr("\nfree_running "));
    return result.err + result.out;
  }
};

// A daemon of plain Python, as a user would write it, found beside its own file.
TEST_F(ProgramsCommand, ThePythonExampleSynchronisesCameras) {
  const std::string example = std::string(SIMBENCH_SOURCE_DIR) + "/examples/cristian.json";
  const ProgramResult result =
      run({"run", "--scenario", "9cam_3host_30fps_azure_kinect", "--seeds", "1", "--pipelines",
           "k4a", "--program", "cristian=" + example, "--program-log", "logs", "--set",
           "/timeline/frames=30", "--format", "json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Json rows = Json::parse(result.out)["rows"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1]["pipeline"], "cristian");
  EXPECT_EQ(rows[1]["host_sync"], "program python3");
  EXPECT_EQ(rows[1]["notes"], Json::array());
  EXPECT_LT(rows[1]["host_error_ms"]["median"].get<double>(), 1);
  EXPECT_TRUE(std::filesystem::exists(folder() / "logs/cristian/seed1/host1/0_python3.log"));
}

// ntpd writes down what it exchanged: that proves how far frames are apart, and the truth lies
// within.
TEST_F(ProgramsCommand, WhatNtpdLoggedCertifiesItsRecording) {
  const std::string ntpd = std::string(SIMBENCH_SOURCE_DIR) + "/examples/ntpd_rawstats.json";
  const ProgramResult record =
      run({"record", "--scenario", "18cam_6host_45fps_lan", "--program", "ntpd=" + ntpd,
           "--pipelines", "ntpd", "--program-log", "logs", "--set", "/cameras/count=6", "--set",
           "/hosts/count=2", "--set", "/timeline/frames=45", "-o", "monday"});
  ASSERT_EQ(record.status, 0) << record.err;
  const ProgramResult without = run({"certify", "monday", "--json"});
  ASSERT_EQ(without.status, 0) << without.err;
  EXPECT_EQ(Json::parse(without.out)["rows"][0]["certified_ms"]["p95"], nullptr);
  const ProgramResult with =
      run({"certify", "monday", "--json", "--clock-log", "1=logs/ntpd/seed1/host1/rawstats",
           "--host-address", "0=10.0.0.1"});
  ASSERT_EQ(with.status, 0) << with.err;
  const Json row = Json::parse(with.out)["rows"][0];
  EXPECT_GT(row["messages"], 10);
  EXPECT_EQ(row["contradicted"], Json::array());
  EXPECT_LT(row["certified_ms"]["p95"].get<double>(), 5);
  EXPECT_EQ(row["truth_outside"], 0);
}

TEST_F(ProgramsCommand, ABuiltInNameIsARowOfTheLeaderboard) {
  const ProgramResult result = clocks({"--program", "chronyd"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("\nchronyd "), HasSubstr("chronyd = program chronyd"),
                                Not(HasSubstr("What went wrong"))));
}

TEST_F(ProgramsCommand, AModelBesideItsProgramHasTheGap) {
  const ProgramResult result = run({"clocks", "--scenario", "leaderboard_programs", "--pipelines",
                                    "chrony,chronyd", "--seeds", "1", "--duration-s", "310"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("\nPrograms beside their models\n"));
}

TEST_F(ProgramsCommand, WhatCannotRunIsOneLineAndTheOtherRowsGoOn) {
  EXPECT_THAT(said_of("no_such_daemon"), HasSubstr("pipeline one: no_such_daemon is not there"));
  EXPECT_THAT(said_of("./daemon"), HasSubstr("a relative path"));
  EXPECT_THAT(said_of("{mastr}"), HasSubstr("found the placeholder {mastr}, allowed: {master}"));
}

TEST_F(ProgramsCommand, AProgramThatEndsIsANoteOfItsRow) {
  EXPECT_THAT(said_of("/bin/false"),
              AllOf(HasSubstr("What went wrong"), HasSubstr("false: exited with status 1")));
}

// It ends with the file's text, or with what Python says of one that it may not read: below /tmp
// that is not there.
TEST_F(ProgramsCommand, AFileOfTheMachineIsReadWhereItIsNamed) {
  file("note.txt", "the text of the note");
  const auto ending = [this](const Json& readable) {
    const Json command = Json::array(
        {"/usr/bin/python3", "-c", "import os; print(open(os.environ['NOTE']).read())"});
    write("one.json", {{"master", Json::array({command})},
                       {"slave", Json::array({command})},
                       {"environment", {{"NOTE", "{here}/note.txt"}}},
                       {"readable", readable}});
    return clocks({"--program", "one=one.json"}).out;
  };
  if (!std::filesystem::exists("/usr/bin/python3")) GTEST_SKIP() << "no python3";
  EXPECT_THAT(ending(Json::array()), HasSubstr("FileNotFoundError"));
  EXPECT_THAT(ending({"{here}/note.txt"}), HasSubstr("the text of the note"));
  EXPECT_THAT(ending({"{here}"}), HasSubstr("the text of the note"));
}

// Its programs' files lie where nobody may not go.
TEST_F(ProgramsCommand, RootIsToldOfProgramsThatAreNotNobodys) {
  if (geteuid() != 0) GTEST_SKIP() << "for root";
  const ProgramResult closed = clocks({"--program", "chronyd", "--program-log", "logs"});
  EXPECT_THAT(closed.err, HasSubstr("note: chronyd runs as root, without root's capabilities, and "
                                    "not as nobody: nobody may not enter or read " +
                                    folder().string()));
  const ProgramResult open = clocks({"--program", "chronyd"});
  EXPECT_THAT(open.err, Not(HasSubstr("note: chronyd runs as root")));
}

// The programs are those of tests/programs/endings.cc.
class FailedProgram : public ProgramsCommand {
 protected:
  // A pipeline that runs this on each slave.
  std::string pipeline(const std::string& name, const std::vector<std::string>& words) const {
    const std::filesystem::path bin = std::filesystem::path(SIMBENCH_PROGRAM).parent_path();
    const auto command = [&bin](std::vector<std::string> all) {
      all.insert(all.begin(), (bin / "simbench_endings").string());
      return Json::array({all});
    };
    write(name + ".json",
          {{"master", command({"wait"})}, {"slave", command(words)}, {"run_before_capture_s", 2}});
    return name + "=" + name + ".json";
  }
  ProgramResult run_cameras(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "run", "--scenario", "9cam_3host_30fps_azure_kinect", "--pipelines",
        "k4a", "--set",      "/timeline/frames=30",           "--no-levers"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(FailedProgram, ItsRowHasNoNumbersAndTheStatusSaysSo) {
  const std::string mine = pipeline("mine", {"late"});
  const ProgramResult result =
      run_cameras({"--program", mine, "--seeds", "2", "--format", "json", "-o", "out"});
  EXPECT_EQ(result.status, 5) << result.err;
  EXPECT_THAT(names_in("out"), testing::Contains("results.json")) << "written all the same";
  const Json answer = Json::parse(result.out)["answer"];
  EXPECT_EQ(answer["failed"][0]["pipeline"], "mine");
  const Json row = Json::parse(result.out)["rows"][1];
  EXPECT_EQ(row["standing"], "failed");
  EXPECT_THAT(
      row["failed"].get<std::string>(),
      AllOf(StartsWith("a program ended in 2 of 2 seeds: seed 1, host "), HasSubstr(", at 2.4"),
            HasSubstr(" s: simbench_endings: exited with status 4: lost patience")));
  for (const char* const metric : {"amd_ms", "absolute_error_ms", "host_error_ms", "max_te_ms"}) {
    EXPECT_EQ(row[metric]["values"], Json::array({nullptr, nullptr})) << metric;
  }
  EXPECT_EQ(row["program_failures"].size(), 4U) << "two slaves, two seeds";
  EXPECT_EQ(row["program_failures"][0]["how"], "exited with status 4");
  EXPECT_TRUE(row["program_failures"][0]["log"].is_null());
  EXPECT_THAT(result.err,
              HasSubstr("note: simulates 2 seeds of 3 hosts: 2 pipelines, of which mine "
                        "(simbench_endings, "));
}

TEST_F(FailedProgram, NoFormatHasNumbersOfIt) {
  const std::string mine = pipeline("mine", {"late"});
  for (const char* const format : {"table", "markdown", "latex", "csv"}) {
    const ProgramResult result =
        run_cameras({"--program", mine, "--seeds", "1", "--format", format, "--verbose"});
    EXPECT_EQ(result.status, 5);
    std::istringstream lines(result.out);
    int rows = 0;
    for (std::string line; std::getline(lines, line);) {
      // The cells of its rows: the name, words, counts of 0, and "-" or nothing.
      if (line.find("mine ") != 0 && line.find("mine,") != 0 && line.find("| mine ") != 0 &&
          line.find("    mine ") != 0) {
        continue;
      }
      if (line.find("mine =") != std::string::npos) continue;
      ++rows;
      EXPECT_EQ(line.find(" us"), std::string::npos) << line;
      EXPECT_EQ(line.find(" ms"), std::string::npos) << line;
      EXPECT_EQ(line.find(" %"), std::string::npos) << line;
    }
    EXPECT_GT(rows, 0) << format << result.out;
  }
  const ProgramResult tidy = run_cameras({"--program", mine, "--seeds", "1", "--format", "tidy"});
  EXPECT_THAT(tidy.out, AllOf(HasSubstr(",k4a,"), Not(HasSubstr(",mine,"))));
}

TEST_F(FailedProgram, OneSeedOfFourFailsItsRowAlone) {
  const ProgramResult result = run_cameras(
      {"--program", pipeline("mine", {"unlucky", "{host}"}), "--seeds", "4", "--format", "json"});
  EXPECT_EQ(result.status, 0) << "not in every seed";
  const Json row = Json::parse(result.out)["rows"][1];
  EXPECT_EQ(row["standing"], "failed");
  const std::size_t failed = row["program_failures"].size();
  EXPECT_GT(failed, 0U);
  EXPECT_LT(failed, 4U);
  EXPECT_EQ(row["program_failures"][0]["host"], 2);
  std::size_t without_values = 0;
  for (const Json& value : row["amd_ms"]["values"]) without_values += value.is_null() ? 1 : 0;
  EXPECT_EQ(without_values, failed);
  EXPECT_EQ(row["scored_seeds"], 4 - failed);
}

TEST_F(FailedProgram, LogsAreNamed) {
  const ProgramResult result = run_cameras(
      {"--program", pipeline("mine", {"late"}), "--seeds", "1", "--program-log", "logs"});
  EXPECT_THAT(result.out, HasSubstr("What the program of mine printed: logs/mine/seed1/host"));
  const ProgramResult without = run_cameras({"--program", "mine=mine.json", "--seeds", "1"});
  EXPECT_THAT(without.out, HasSubstr("--program-log DIR keeps what programs print"));
}

TEST_F(FailedProgram, OneShotClientsHaveNotFailed) {
  const ProgramResult result =
      run_cameras({"--program", pipeline("mine", {"set"}), "--seeds", "1", "--format", "json"});
  EXPECT_EQ(result.status, 0);
  const Json row = Json::parse(result.out)["rows"][1];
  EXPECT_EQ(row["program_failures"], Json::array());
  EXPECT_EQ(row["unsynchronised_hosts"], 0);
  EXPECT_FALSE(row["host_error_ms"]["median"].is_null());
}

// Its world begins two hours before the time that oscillators are drawn for.
TEST_F(FailedProgram, MonotonicClocksAreNotNegative) {
  pipeline("mine", {"steady"});
  Json program = Json::parse(content("mine.json"))["host_sync"]["program"];
  program["run_before_capture_s"] = 7200;
  write("mine.json", program);
  const ProgramResult result =
      run_cameras({"--program", "mine=mine.json", "--seeds", "1", "--format", "json"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(Json::parse(result.out)["rows"][1]["program_failures"], Json::array());
}

TEST_F(FailedProgram, OtherCommandsSayItToo) {
  const std::string mine = pipeline("mine", {"late"});
  const std::vector<std::string> world = {"--scenario", "9cam_3host_30fps_azure_kinect",
                                          "--set",      "/timeline/frames=30",
                                          "--program",  mine};
  const auto with = [&world](std::vector<std::string> words) {
    words.insert(words.begin() + 1, world.begin(), world.end());
    return words;
  };
  const ProgramResult recorded = run(with({"record", "--pipelines", "mine", "-o", "rec"}));
  EXPECT_EQ(recorded.status, 5);
  EXPECT_THAT(recorded.err, HasSubstr("exited with status 4: lost patience"));
  const ProgramResult replayed = run({"replay", "rec", "--format", "json"});
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  const Json row = Json::parse(replayed.out)["rows"][0];
  EXPECT_EQ(row["standing"], "failed");
  EXPECT_TRUE(row["amd_ms"]["values"][0].is_null());
  const ProgramResult traced = run(with({"trace", "-o", "trace.json"}));
  EXPECT_EQ(traced.status, 5);
  EXPECT_THAT(traced.err, HasSubstr("warning: hosts 1, 2, first at 2.4"));
  const ProgramResult budget =
      run(with({"run", "--pipelines", "mine", "--seeds", "1", "--budget"}));
  EXPECT_EQ(budget.status, 5);
  EXPECT_THAT(budget.out, HasSubstr("mine failed: a program ended"));
  const ProgramResult clocks_run = clocks({"--program", mine, "--format", "json"});
  EXPECT_EQ(clocks_run.status, 5);
  EXPECT_EQ(Json::parse(clocks_run.out)["rows"][1]["standing"], "failed");
}

TEST_F(FailedProgram, ASweepHasNoValuesOfIt) {
  pipeline("mine", {"late"});
  Json own = Json::parse(content("mine.json"));
  own.update({{"name", "mine"}, {"device_time", "regression_30"}, {"gathering", "yoon2021"}});
  file("rig.json", Json{{"schema_version", 1},
                        {"name", "rig"},
                        {"summary", "A rig with a program that ends."},
                        {"base", "9cam_3host_30fps_azure_kinect"},
                        {"timeline", {{"frames", 30}}},
                        {"pipelines", Json::array({own})}}
                       .dump());
  for (const bool of_clocks : {false, true}) {
    std::vector<std::string> command = {"sweep",
                                        "--scenario",
                                        "rig.json",
                                        "--sweep",
                                        "/network/latency_fixed_ms=0.1,0.2",
                                        "--seeds",
                                        "2",
                                        "-o",
                                        of_clocks ? "clocks" : "captures"};
    if (of_clocks) command.insert(command.end(), {"--clocks", "--duration-s", "310"});
    const ProgramResult result = run(command);
    EXPECT_EQ(result.status, 5) << result.err;
    EXPECT_THAT(result.out, AllOf(HasSubstr("No pipeline that a rig can run has a value"),
                                  HasSubstr("mine failed at 2 of 2 points: a program ended")));
  }
  EXPECT_THAT(content("captures/sweep.csv"), HasSubstr("0.1,mine,1,,,,"));
  EXPECT_THAT(content("clocks/sweep.csv"), HasSubstr("\"host "));
}

TEST_F(FailedProgram, IsNotCompared) {
  run_cameras({"--program", pipeline("mine", {"unlucky", "{host}"}), "--seeds", "4", "-o", "out"});
  const ProgramResult compared = run({"compare", "out", "--with-baseline", "k4a"});
  EXPECT_EQ(compared.status, 0);
  EXPECT_THAT(compared.out, AllOf(HasSubstr("no values"), HasSubstr("mine failed, so nothing of "
                                                                    "it is compared")));
  const ProgramResult reported = run({"report", "out", "-o", "page.html"});
  EXPECT_EQ(reported.status, 0) << reported.err;
  EXPECT_THAT(content("page.html"), HasSubstr("mine failed: a program ended in "));
}

TEST_F(ProgramsCommand, ClocksWithProgramsRunTenMinutesUnlessToldOtherwise) {
  const std::string example = std::string(SIMBENCH_SOURCE_DIR) + "/examples/cristian.json";
  const std::vector<std::string> command = {
      "clocks", "--scenario",       "6host_star",   "--set",     "/hosts/count=3",
      "--set",  "/cameras/count=3", "--seeds",      "1",         "--format",
      "json",   "--pipelines",      "free_running", "--program", "cristian=" + example};
  const ProgramResult result = run(command);
  ASSERT_EQ(result.status, 0) << result.err;
  const Json root = Json::parse(result.out);
  EXPECT_EQ(root["duration_s"], 600);
  EXPECT_THAT(root["period_note"].get<std::string>(),
              AllOf(StartsWith("Simulated 600 s, without the loss of the master"),
                    HasSubstr("--duration-s")));
  EXPECT_TRUE(root["rows"][1]["holdover_ms"]["600"].is_null());
  EXPECT_THAT(result.err, HasSubstr("cristian (python3, 600 s each) runs real programs"));
  const ProgramResult algorithms = run({"clocks", "--scenario", "6host_star", "--pipelines",
                                        "free_running", "--seeds", "1", "--format", "json"});
  EXPECT_EQ(Json::parse(algorithms.out)["duration_s"], 36'000);
  EXPECT_FALSE(Json::parse(algorithms.out).contains("period_note"));
}

// Folders of hosts are temporary files.
TEST_F(ProgramsCommand, NoSignalLeavesAFolderBehind) {
  for (const char* const number : {"INT", "TERM"}) {
    for (const char* const after_s : {"0.05", "0.5", "1.5"}) {
      const std::string command = fmt::format(
          "cd {} && mkdir -p temporary && TMPDIR=$PWD/temporary timeout -s {} {} {} clocks "
          "--scenario 6host_star --pipelines chronyd --program chronyd --seeds 100000 > /dev/null "
          "2>&1",
          folder().string(), number, after_s, SIMBENCH_PROGRAM);
      EXPECT_NE(std::system(command.c_str()), 0);
      EXPECT_THAT(names_in("temporary"), testing::IsEmpty()) << number << " after " << after_s;
    }
  }
}

TEST_F(ProgramsCommand, APatienceThatIsNoNumberIsRefused) {
  ProgramOptions options;
  options.environment = {"SIMBENCH_PATIENCE_S=long"};
  const ProgramResult result =
      run({"clocks", "--scenario", "6host_star", "--program", "chronyd"}, options);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("SIMBENCH_PATIENCE_S: found 'long', allowed: a whole number"));
}

// How many processes work in the test's folder or below it.
std::size_t processes_in(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    std::error_code gone;
    const std::filesystem::path at = std::filesystem::read_symlink(process.path() / "cwd", gone);
    count += !gone && at.string().starts_with(folder.string() + "/logs");
  }
  return count;
}

// Their end is the kernel's, a moment after their starter's: waits for it, however busy the
// machine.
bool all_programs_end(const std::filesystem::path& folder) {
  for (int tried = 0; tried < 3000 && processes_in(folder) > 0; ++tried) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return processes_in(folder) == 0;
}

TEST_F(ProgramsCommand, NoProgramOutlivesCtrlC) {
  ProgramOptions options;
  options.interrupt_after = std::chrono::seconds(2);
  const ProgramResult result =
      run({"clocks", "--scenario", "6host_star", "--pipelines", "chronyd", "--program", "chronyd",
           "--program-log", "logs", "--seeds", "100000"},
          options);
  EXPECT_EQ(result.status, 130);
  EXPECT_TRUE(all_programs_end(folder()));
}

TEST_F(ProgramsCommand, NoProgramOutlivesAKill) {
  const std::string command = fmt::format(
      "cd {} && timeout -s KILL 2 {} clocks --scenario 6host_star --pipelines chronyd --program "
      "chronyd --program-log logs --seeds 100000 > /dev/null 2>&1",
      folder().string(), SIMBENCH_PROGRAM);
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_TRUE(all_programs_end(folder()));
}

// Programs are refused with a reason, and all else works.
TEST_F(ProgramsCommand, OlderKernelsRunWhatTheyCan) {
  write("one.json", {{"master", Json::array({Json::array({"/bin/true"})})},
                     {"slave", Json::array({Json::array({"/bin/true"})})}});
  const auto said = [this](const std::vector<std::string>& lacking) {
    const ProgramResult result =
        run({"clocks", "--scenario", "6host_star", "--seeds", "1", "--duration-s", "10", "--from-s",
             "0", "--pipelines", "free_running", "--program", "one=one.json"},
            {.kernel_without = lacking});
    EXPECT_THAT(result.out, HasSubstr("\nfree_running "));
    return result.out + result.err;
  };
  EXPECT_THAT(said({"seccomp"}), HasSubstr("this kernel has no seccomp filters"));
  const bool is_refused =
      said({"landlock"}).find("this kernel has no Landlock, without which root's programs") !=
      std::string::npos;
  EXPECT_EQ(is_refused, geteuid() == 0);
  EXPECT_THAT(said({"landlock", "seccomp"}), HasSubstr("this kernel has no seccomp filters"))
      << "without which another user could not either";
  EXPECT_THAT(said({"close_range"}), Not(HasSubstr("this kernel")));
}

TEST_F(ProgramsCommand, FilesThatAreNoPipelines) {
  const auto refusal = [this](const std::string& text) {
    file("bad.json", text);
    const ProgramResult result = clocks({"--program", "bad=bad.json"});
    EXPECT_EQ(result.status, 2) << text;
    return result.err;
  };
  EXPECT_THAT(refusal("{"), StartsWith("error: --program bad=bad.json: "));
  EXPECT_THAT(refusal("{}"), HasSubstr("found no \"host_sync\""));
  EXPECT_THAT(refusal(R"({"host_sync": {"program": {"master": [], "slave": [["a"]]}}})"),
              HasSubstr("/host_sync/program/master"));
  EXPECT_THAT(refusal(R"({"host_sync": {"program": {"master": [["a"]], "slave": [["a"]],
                          "files": {"../a": "b"}}}})"),
              HasSubstr("allowed: a path within the host's folder"));
  EXPECT_THAT(refusal(R"({"host_sync": {"program": {"master": [["a"]], "slave": [["a"]],
                          "environment": {"LD_PRELOAD": "b"}}}})"),
              HasSubstr("LD_"));
  EXPECT_THAT(
      refusal(R"({"host_sync": {"program": {"master": [["a"]], "slave": [["a"]],
                          "readable": ["/etc/ntp", "keys"]}}})"),
      HasSubstr("/host_sync/program/readable/1: found \"keys\", allowed: an absolute path"));
  EXPECT_THAT(refusal(R"({"host_sync": {"program": {"master": [["a"]], "slave": [["a"]],
                          "readable": "/etc/ntp"}}})"),
              HasSubstr("/host_sync/program/readable"));
  const ProgramResult missing = clocks({"--program", "bad=there_is_none.json"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("there_is_none.json"));
  const ProgramResult unknown = clocks({"--program", "chrond"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("chronyd, chronyd_lan"));
}

}  // namespace
}  // namespace simbench
