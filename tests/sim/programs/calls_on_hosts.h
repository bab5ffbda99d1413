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

// A script of tests/programs.
inline std::string test_script(const std::string& name) {
  return std::string(SIMBENCH_SOURCE_DIR) + "/tests/programs/" + name;
}

class CallsOnHosts : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Runs the program on all hosts, with these words; returns what each host's first said.
  std::vector<std::string> run(const std::string& program, std::vector<Words> master,
                               std::vector<Words> slave,
                               const std::vector<scenarios::Override>& changes = {},
                               double seconds = 60) {
    for (std::vector<Words>* commands : {&master, &slave}) {
      for (Words& each : *commands) each.insert(each.begin(), test_program(program));
    }
    return run_commands(std::move(master), std::move(slave), "simbench_" + program, changes,
                        seconds);
  }

  // The same with whole commands, of which the first has this name.
  std::vector<std::string> run_commands(std::vector<Words> master, std::vector<Words> slave,
                                        const std::string& name,
                                        const std::vector<scenarios::Override>& changes = {},
                                        double seconds = 60) {
    std::filesystem::remove_all(folder_);
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
      outputs.push_back(output(host, name));
    }
    return outputs;
  }

 private:
  std::string output(std::size_t host, const std::string& name) const {
    const auto path = fmt::format("{}/test/seed1/host{}/0_{}.log", folder_, host, name);
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  const std::string folder_ =
      testing::TempDir() + "/calls" + testing::UnitTest::GetInstance()->current_test_info()->name();
};

}  // namespace simbench::sim
