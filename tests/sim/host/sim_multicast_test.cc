#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

#include "sim/host/sim_channel.h"
#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

constexpr std::uint32_t kPtpGroup = 0xE0000181;

// Receives what host 0 sends.
Task<void> receive_copies(SimWorld& world, std::size_t host, std::vector<Bytes>& copies,
                          std::vector<double>& at_ms) {
  MessageChannel& channel = world.host(host).open_channel(0, Transport::kDatagram);
  for (;;) {
    std::optional<ReceivedMessage> got = co_await channel.receive(kNoDeadline);
    copies.push_back(std::move(got->bytes));
    at_ms.push_back(world.now_ms());
  }
}

struct SentToGroup {
  double returned_ms = 0;
  std::optional<HostTime> left;
};

Task<void> send_to_all(SimWorld& world, Bytes message, SentToGroup& sent) {
  SimMulticast& multicast = world.host(0).multicast();
  const MessageId id = co_await multicast.send(kPtpGroup, std::move(message));
  sent.returned_ms = world.now_ms();
  sent.left = co_await multicast.stamp(id, kNoDeadline);
}

TEST(SimMulticastTest, OneCallAndOnePassageOfThePortReachAllMembers) {
  scenarios::Scenario scenario = ideal_hosts(4);
  scenario.hosts.send_cost_ms = 2;
  scenario.network.latency_fixed_ms = 1;
  scenario.network.bandwidth_mbit_per_s = 8;  // 1 us a byte
  scenario.network.stamp_point = scenarios::StampPoint::kKernel;
  SimWorld world(scenario);
  for (const PeerId member : {0u, 1u, 3u}) world.hosts.network().groups().join(kPtpGroup, member);
  std::vector<Bytes> copies[4];
  std::vector<double> came_ms[4];
  for (const std::size_t host : {1, 2, 3}) {
    world.spawn(receive_copies(world, host, copies[host], came_ms[host]));
  }
  SentToGroup sent;
  world.spawn(send_to_all(world, Bytes(100), sent));
  world.engine.run();
  EXPECT_EQ(sent.returned_ms, 2);
  EXPECT_EQ(sent.left, world.hosts.clock(0).read(TrueTime(from_ms(2))));
  for (const std::size_t member : {1, 3}) {
    ASSERT_EQ(came_ms[member].size(), 1u) << "host " << member;
    EXPECT_NEAR(came_ms[member][0], 2 + 0.1 + 0.1 + 1, 1e-6) << "host " << member;
  }
  EXPECT_TRUE(came_ms[2].empty()) << "no member";
}

// 52 bytes at 8 Mbit/s: 52 us on the switch's port to each member.
TEST(SimMulticastTest, ATransparentSwitchCorrectsEveryCopy) {
  scenarios::Scenario scenario = ideal_hosts(3);
  scenario.network.bandwidth_mbit_per_s = 8;
  scenario.network.switch_clock = scenarios::SwitchClockKind::kTransparent;
  SimWorld world(scenario);
  std::vector<Bytes> copies[3];
  std::vector<double> came_ms[3];
  for (const std::size_t member : {1, 2}) {
    world.hosts.network().groups().join(kPtpGroup, static_cast<PeerId>(member));
    world.spawn(receive_copies(world, member, copies[member], came_ms[member]));
  }
  Bytes sync(52);
  sync[1] = std::byte{2};   // the version
  sync[3] = std::byte{44};  // the length of the message, before eight bytes of something else
  SentToGroup sent;
  world.spawn(send_to_all(world, sync, sent));
  world.engine.run();
  for (const std::size_t member : {1, 2}) {
    ASSERT_EQ(copies[member].size(), 1u) << "host " << member;
    std::uint64_t field = 0;
    for (std::size_t i = 8; i < 16; ++i) {
      field = (field << 8) | std::to_integer<std::uint64_t>(copies[member][0][i]);
    }
    EXPECT_EQ(field >> 16, 52'000u) << "host " << member;
  }
}

}  // namespace
}  // namespace simbench::sim
