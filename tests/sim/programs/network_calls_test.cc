// Programs that look at the calls of the network, in a world of three hosts.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "sim/programs/program_sync.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t kCallingHosts = 3;

using Words = std::vector<std::string>;

class NetworkCallsTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Runs the program on all hosts, with these words; returns what each host's first said.
  std::vector<std::string> run(const std::string& program, std::vector<Words> master,
                               std::vector<Words> slave,
                               const std::vector<scenarios::Override>& changes = {}) {
    const std::string path = std::string(SIMBENCH_PROGRAMS) + "/simbench_" + program;
    for (std::vector<Words>* commands : {&master, &slave}) {
      for (Words& each : *commands) each.insert(each.begin(), path);
    }
    return run_commands(std::move(master), std::move(slave), "simbench_" + program, changes);
  }

  // The same with whole commands, of which the first has this name.
  std::vector<std::string> run_commands(std::vector<Words> master, std::vector<Words> slave,
                                        const std::string& name,
                                        const std::vector<scenarios::Override>& changes = {}) {
    std::filesystem::remove_all(folder_);
    ProgramSync sync(
        {.pipeline = "test",
         .programs = {.master = std::move(master), .slave = std::move(slave), .files = files_},
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
    for (std::size_t host = 0; host < kCallingHosts; ++host) {
      outputs.push_back(output(host, name));
    }
    return outputs;
  }

  static std::string text_of(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  std::map<std::string, std::string> files_;  // of each host

 private:
  std::string output(std::size_t host, const std::string& name) const {
    return text_of(fmt::format("{}/test/seed1/host{}/0_{}.log", folder_, host, name));
  }

  const std::string folder_ = testing::TempDir() + "/network_calls" +
                              testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(NetworkCallsTest, GroupsDoWhatManPagesPromise) {
  const std::vector<std::string> said = run("group_calls", {{"check"}}, {{"answer"}});
  EXPECT_EQ(said[0], "done\n");
  EXPECT_EQ(said[1], "");
}

TEST_F(NetworkCallsTest, Ipv6DoesWhatManPagesPromise) {
  const std::vector<std::string> said = run("ipv6_calls", {{"check"}}, {{"answer"}});
  EXPECT_EQ(said[0], "done\n");
  EXPECT_EQ(said[1], "");
}

// The same script says the same on two real hosts with these names and addresses.
TEST_F(NetworkCallsTest, PythonsSocketsSpeakIpv6) {
  const std::string python = "/usr/bin/python3";
  if (!std::filesystem::exists(python)) GTEST_SKIP() << python << " is not there";
  const std::string script = "{files}/ipv6_sockets.py";
  files_["ipv6_sockets.py"] = text_of(SIMBENCH_SOURCE_DIR "/tests/programs/ipv6_sockets.py");
  EXPECT_EQ(run_commands({{python, script, "ask"}}, {{python, script, "serve"}}, "python3")[0],
            "60000 b'YYY' fd00::2 4000 0 0\n"
            "60000 b'YYY' 10.0.0.2 4000\n"
            "b'LINK' fe80::aff:fe00:2%eth0\n"
            "[Errno 111] Connection refused\n"
            "b'HOST1' fd00::2\n"
            "b'FD00::2' fd00::2\n"
            "b'10.0.0.2' 10.0.0.2\n"
            "b'LOOPBACK' ::1\n"
            "True host1 host0\n"
            "done\n");
}

TEST_F(NetworkCallsTest, PacketSocketsDoWhatManPagesPromise) {
  const std::vector<std::string> said =
      run("packet_calls", {{"check", "stamps"}}, {{"answer"}},
          {{"/hosts/nic/hardware_stamps", "true"}, {"/network/bandwidth_mbit_per_s", "1000"}});
  EXPECT_EQ(said[0], "done\n");
  EXPECT_EQ(said[1], "");
}

TEST_F(NetworkCallsTest, InterfacesAndNamesAreThoseOfTheWorld) {
  for (const char* stamps : {"false", "true"}) {
    const std::vector<std::string> said =
        run("interface_calls", {{"{host}", "{address}"}}, {{"{host}", "{address}"}},
            {{"/hosts/nic/hardware_stamps", stamps}});
    EXPECT_THAT(said, Each(std::string("done\n")));
  }
}

TEST_F(NetworkCallsTest, TheCardsClockAndStampsDoWhatLinuxPromises) {
  const std::vector<std::string> said =
      run("card_calls", {{"answer"}}, {{"check", "{master}"}},
          {{"/hosts/nic/hardware_stamps", "true"}, {"/network/bandwidth_mbit_per_s", "1000"}});
  EXPECT_THAT(said, ElementsAre("", "done\n", "done\n"));
}

TEST_F(NetworkCallsTest, ProgramsOfAHostSpeakOverUnixSockets) {
  const std::vector<Words> both = {{"ask"}, {"answer"}};
  EXPECT_THAT(run("local_calls", both, both), Each(std::string("done\n")));
}

TEST_F(NetworkCallsTest, ConnectionsAndCopiesOfDescriptorsDoWhatManPagesPromise) {
  EXPECT_THAT(run("stream_calls", {{"serve"}}, {{"check", "{master}"}}),
              ElementsAre("", "done\n", "done\n"));
}

}  // namespace
}  // namespace simbench::sim
