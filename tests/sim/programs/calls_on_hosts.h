// A world of three hosts that run a program of tests/programs, and what it said.
//
//   class NetworkCallsTest : public CallsOnHosts {};
//   TEST_F(NetworkCallsTest, Answers) { EXPECT_EQ(run("calls", {{"echo"}}, {{"echo"}})[0], ""); }
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/program_sync.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {

inline constexpr std::size_t kCallingHosts = 3;

using Words = std::vector<std::string>;

// A program of tests/programs.
inline std::string test_program(const std::string& name) {
  return std::string(SIMBENCH_PROGRAMS) + "/simbench_" + name;
}

class CallsOnHosts : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Runs the program on all hosts, with these words; returns what each host's first said.
  std::vector<std::string> run(const std::string& program, std::vector<Words> master,
                               std::vector<Words> slave,
                               const std::vector<scenarios::Override>& changes = {},
                               double seconds = 60) {
    std::filesystem::remove_all(folder_);
    const std::string path = test_program(program);
    for (std::vector<Words>* commands : {&master, &slave}) {
      for (Words& each : *commands) each.insert(each.begin(), path);
    }
    ProgramSync sync({.pipeline = "test",
                      .programs = {.master = std::move(master), .slave = std::move(slave)},
                      .shim = SIMBENCH_SHIM,
                      .log_folder = folder_,
                      .hosts = kCallingHosts});
    std::vector<scenarios::Override> all{{"/hosts/count", "3"}, {"/cameras/count", "3"}};
    all.insert(all.end(), changes.begin(), changes.end());
    ServiceWorld world(scenarios::load_scenario("6host_star", all), 1);
    world.start(sync);
    world.run_until(seconds);
    for (const SyncOutcome& outcome : world.record.outcomes) {
      // These look at calls, and need not set a clock.
      EXPECT_THAT(outcome.message, testing::HasSubstr("no program has set its clock"));
    }
    std::vector<std::string> outputs;
    for (std::size_t host = 0; host < kCallingHosts; ++host) {
      outputs.push_back(output(host, program));
    }
    return outputs;
  }

 private:
  std::string output(std::size_t host, const std::string& program) const {
    const auto path = fmt::format("{}/test/seed1/host{}/0_simbench_{}.log", folder_, host, program);
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  const std::string folder_ =
      testing::TempDir() + "/calls" + testing::UnitTest::GetInstance()->current_test_info()->name();
};

}  // namespace simbench::sim
