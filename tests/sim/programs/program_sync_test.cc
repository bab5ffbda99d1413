#include "sim/programs/program_sync.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"
#include "tests/sim/host/service_world.h"
#include "tests/sim/programs/calls_on_hosts.h"

namespace simbench::sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using Command = scenarios::HostPrograms::Command;

constexpr std::size_t kHosts = 3;

scenarios::Scenario star() {
  return scenarios::load_scenario("6host_star", {{"/hosts/count", "3"}, {"/cameras/count", "3"}});
}

class ProgramSyncTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Runs it for a while; returns each host's first output.
  std::vector<std::string> run(Command master, Command slave, double seconds,
                               std::uint64_t seed = 1) {
    host_folder_ = fmt::format("{}/test/seed{}/host", folder_, seed);
    const std::string logs[] = {"0_" + scenarios::program_name(master) + ".log",
                                "0_" + scenarios::program_name(slave) + ".log"};
    std::filesystem::remove_all(folder_);
    programs_.master = {std::move(master)};
    programs_.slave = {std::move(slave)};
    programs_.files = {{"address.txt", "{host} of {master}: {address}\n"}};
    ProgramSync sync({.pipeline = "test",
                      .programs = programs_,
                      .shim = SIMBENCH_SHIM,
                      .log_folder = folder_,
                      .hosts = kHosts});
    ServiceWorld world(star(), seed);
    world.start(sync);
    world.run_until(seconds);
    largest_error_s_ = std::max(std::abs(world.error_s(1)), std::abs(world.error_s(2)));
    outcomes_ = world.record.outcomes;
    std::vector<std::string> outputs;
    for (std::size_t host = 0; host < kHosts; ++host) {
      outputs.push_back(content(host, logs[host > 0]));
    }
    return outputs;
  }

  std::string content(std::size_t host, const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(fmt::format("{}{}/{}", host_folder_, host, name)).rdbuf();
    return text.str();
  }

  // What the first slave's outcome says of a program in this mode.
  std::string ending_of(const std::string& mode) { return ending_of("calls", mode); }
  std::string ending_of(const std::string& program, const std::string& mode) {
    run({test_program("calls"), "echo"}, {test_program(program), mode}, 2);
    return outcomes_.empty() ? "no outcome" : outcomes_.front().message;
  }

  const std::string folder_ = testing::TempDir() + "/programs" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
  scenarios::HostPrograms programs_;
  std::string host_folder_;
  double largest_error_s_ = 0;
  std::vector<SyncOutcome> outcomes_;
};

TEST_F(ProgramSyncTest, CallsDoWhatManPagesPromise) {
  const std::vector<std::string> outputs =
      run({test_program("calls"), "echo"}, {test_program("calls"), "check", "{master}"}, 60);
  EXPECT_EQ(outputs[0], "");
  for (const std::size_t slave : {1, 2}) {
    std::vector<std::string> lines;
    std::istringstream text(outputs[slave]);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    EXPECT_THAT(lines, ElementsAre(StartsWith("chance "), "done")) << "host " << slave;
  }
  EXPECT_NE(outputs[1], outputs[2]) << "each has chances of its own";
}

TEST_F(ProgramSyncTest, SignalsComeInTheWorldsTime) {
  const std::vector<std::string> outputs =
      run({test_program("signals"), "check"}, {test_program("signals"), "check"}, 60);
  EXPECT_THAT(outputs, testing::Each("done\n"));
}

// It steps its clock once a second by what it measured: the mean of two exponential delays of 50 us
// each way, beside 10 ppm.
TEST_F(ProgramSyncTest, ADaemonOfPlainSocketsSynchronises) {
  run({test_program("cristian"), "serve"}, {test_program("cristian"), "follow", "{master}"}, 60);
  EXPECT_LT(largest_error_s_, 300e-6);
  EXPECT_GT(largest_error_s_, 0);
  EXPECT_THAT(outcomes_, testing::IsEmpty()) << "they still run";
}

// Then its clock is left to its quartz: some parts per million for ten minutes.
TEST_F(ProgramSyncTest, ProgramsMayEndWhenTheCaptureBegins) {
  programs_.run_before_capture_s = 10;
  programs_.run_during_capture = false;
  run({test_program("cristian"), "serve"}, {test_program("cristian"), "follow", "{master}"}, 600);
  EXPECT_GT(largest_error_s_, 1e-3);
  EXPECT_LT(largest_error_s_, 0.1) << "it was set";
  EXPECT_THAT(outcomes_, testing::IsEmpty()) << "that is no failure";
}

TEST_F(ProgramSyncTest, EqualSeedsGiveEqualBytes) {
  const Command master{test_program("cristian"), "serve"};
  const Command slave{test_program("cristian"), "follow", "{master}"};
  const std::vector<std::string> first = run(master, slave, 20);
  const double error_s = largest_error_s_;
  EXPECT_EQ(run(master, slave, 20), first);
  EXPECT_EQ(largest_error_s_, error_s);
  EXPECT_NE(run(master, slave, 20, 2), first) << "another seed is another world";
}

TEST_F(ProgramSyncTest, FilesAndCommandsKnowTheirHost) {
  run({"/bin/true"}, {"/bin/true"}, 1);
  EXPECT_EQ(content(2, "address.txt"), "2 of 10.0.0.1: 10.0.0.3\n");
}

TEST_F(ProgramSyncTest, AProgramThatEndsIsAFailureWithItsLastWords) {
  EXPECT_THAT(ending_of("exit"), HasSubstr("exited with status 3: what it says last"));
  EXPECT_FALSE(outcomes_.front().synchronised);
}

TEST_F(ProgramSyncTest, WhatCannotBeSimulatedIsSaid) {
  EXPECT_THAT(ending_of("spin"), HasSubstr("never waits"));
  EXPECT_THAT(ending_of("garbage"), HasSubstr("asked what the world does not know"));
}

TEST_F(ProgramSyncTest, AnAlarmWithoutAHandlerEndsTheProgram) {
  EXPECT_THAT(ending_of("signals", "alarm"), HasSubstr("ended by signal ALRM"));
  EXPECT_THAT(ending_of("signals", "thread"), HasSubstr("SIGEV_THREAD"));
}

TEST_F(ProgramSyncTest, AProgramThatIsNotThereIsSaid) {
  run({"/bin/true"}, {folder_ + "/not/there"}, 1);
  ASSERT_FALSE(outcomes_.empty());
  EXPECT_THAT(outcomes_.front().message, HasSubstr("cannot be run"));
}

TEST_F(ProgramSyncTest, NoProcessOutlivesTheWorld) {
  run({test_program("cristian"), "serve"}, {test_program("cristian"), "follow", "{master}"}, 2);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace simbench::sim
