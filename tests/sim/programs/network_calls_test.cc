// Programs that look at the calls of the network, in a world of three hosts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
