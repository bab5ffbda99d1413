// Programs that look at the calls of the network, in a world of three hosts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/sim/programs/calls_on_hosts.h"

namespace simbench::sim {
namespace {

using testing::Each;
using testing::ElementsAre;

class NetworkCallsTest : public CallsOnHosts {};

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
  const std::string script = test_script("ipv6_sockets.py");
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
