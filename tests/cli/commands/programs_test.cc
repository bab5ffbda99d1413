// Pipelines of real programs through the real command line: --program and --program-log.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
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
    EXPECT_EQ(result.status, 0) << "the other row goes on";
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

// It ends with the file's text, or with what Python says of one that it may not read.
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
  EXPECT_THAT(ending(Json::array()), HasSubstr("PermissionError"));
  EXPECT_THAT(ending({"{here}/note.txt"}), HasSubstr("exited with status 0: the text of the note"));
  EXPECT_THAT(ending({"{here}"}), HasSubstr("exited with status 0: the text of the note"));
}

// Its programs' files lie where nobody may not go.
TEST_F(ProgramsCommand, RootIsToldOfProgramsThatAreNotNobodys) {
  if (geteuid() != 0) GTEST_SKIP() << "for root";
  const ProgramResult closed = clocks({"--program", "chronyd", "--program-log", "logs"});
  EXPECT_THAT(closed.err, HasSubstr("note: chronyd runs as root, without root's capabilities, and "
                                    "not as nobody: nobody may not enter or read " +
                                    folder().string()));
  const ProgramResult open = clocks({"--program", "chronyd"});
  EXPECT_THAT(open.err, Not(HasSubstr("note:")));
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
              HasSubstr("allowed: a file name without \"/\""));
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
