// Programs that look at the calls of the network, in a world of three hosts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/program_sync.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

using testing::IsEmpty;

constexpr std::size_t kCallingHosts = 3;

class NetworkCallsTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Runs the program on all hosts; returns what each host's said.
  std::vector<std::string> run(const std::string& program, std::vector<std::string> master,
                               std::vector<std::string> slave,
                               const std::vector<scenarios::Override>& changes = {}) {
    std::filesystem::remove_all(folder_);
    const std::string path = std::string(SIMBENCH_PROGRAMS) + "/simbench_" + program;
    master.insert(master.begin(), path);
    slave.insert(slave.begin(), path);
    ProgramSync sync({.pipeline = "calls",
                      .programs = {.master = {std::move(master)}, .slave = {std::move(slave)}},
                      .shim = SIMBENCH_SHIM,
                      .log_folder = folder_,
                      .hosts = kCallingHosts});
    std::vector<scenarios::Override> all{{"/hosts/count", "3"}, {"/cameras/count", "3"}};
    all.insert(all.end(), changes.begin(), changes.end());
    ServiceWorld world(scenarios::load_scenario("6host_star", all), 1);
    world.start(sync);
    world.run_until(60);
    EXPECT_THAT(world.record.outcomes, IsEmpty()) << world.record.outcomes.front().message;
    std::vector<std::string> outputs;
    for (std::size_t host = 0; host < kCallingHosts; ++host) outputs.push_back(output(host));
    return outputs;
  }

 private:
  std::string output(std::size_t host) const {
    const auto path = std::filesystem::path(folder_) / "calls" / "seed1" /
                      ("host" + std::to_string(host)) / "0_simbench_group_calls.log";
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  const std::string folder_ = testing::TempDir() + "/network_calls" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(NetworkCallsTest, GroupsDoWhatManPagesPromise) {
  const std::vector<std::string> said = run("group_calls", {"check"}, {"answer"});
  EXPECT_EQ(said[0], "done\n");
  EXPECT_EQ(said[1], "");
}

}  // namespace
}  // namespace simbench::sim
