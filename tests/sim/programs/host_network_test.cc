#include "sim/programs/host_network.h"

#include <gtest/gtest.h>
#include <linux/errqueue.h>
#include <poll.h>

#include <cerrno>
#include <cmath>
#include <memory>

#include "shim/addresses.h"
#include "sim/programs/kernel_clock.h"
#include "tests/sim/host/sim_world.h"

namespace simbench::sim {
namespace {

constexpr std::uint16_t kPort = 5000;

scenarios::Scenario two_hosts() {
  scenarios::Scenario scenario = ideal_hosts(2);
  scenario.network.stamp_point = scenarios::StampPoint::kKernel;
  return scenario;
}

// Two hosts, each with a socket of IPv6 that takes both families.
class Pair {
 public:
  explicit Pair(const scenarios::Scenario& scenario, bool is_server_bound = true)
      : world(scenario), client(world.host(0), 2), server(world.host(1), 2) {
    for (auto* end : {&client, &server}) {
      end->socket.family = AF_INET6;
      end->network.open(end->socket);
      world.spawn(end->network.pump(end == &client ? 1 : 0));
      world.spawn(end->network.stamp_departures());
      world.spawn(end->network.answer_refused());
    }
    client.network.bind(client.socket, {.port = kPort, .family = AF_INET6});
    if (is_server_bound) {
      server.network.bind(server.socket, {.port = kPort, .family = AF_INET6});
      server.socket.on_arrival = [this] { arrivals_ms.push_back(world.now_ms()); };
    }
  }

  static Task<void> send(Pair& pair, shim::Address to, std::size_t size, unsigned stamps = 0) {
    pair.error =
        co_await pair.client.network.send(pair.client.socket, {.to = to}, Bytes(size), stamps);
  }
  void run(double until_s) { world.engine.run_until(TrueTime(from_ms(1e3 * until_s))); }

  SimWorld world;
  struct End {
    End(SimHost& host, std::size_t hosts) : network(host, hosts) {}
    HostNetwork network;
    UdpSocket socket{};
  };
  End client;
  End server;
  int error = 0;
  std::vector<double> arrivals_ms;
};

const shim::Address kIpv4 = shim::ipv4_address(0x0A000002, kPort);
const shim::Address kIpv6{.host = shim::unique_local(2), .port = kPort, .family = AF_INET6};

TEST(HostNetworkTest, ADatagramIsAsManyMessagesAsItHasFragments) {
  for (const auto& [to, size, expected] :
       {std::tuple(kIpv4, 65'507U, 45U), std::tuple(kIpv6, 65'527U, 46U),
        std::tuple(kIpv4, 1472U, 1U)}) {
    Pair pair(two_hosts());
    pair.world.spawn(Pair::send(pair, to, size));
    pair.run(1);
    EXPECT_EQ(pair.error, 0);
    EXPECT_EQ(pair.world.hosts.network().messages(), expected);
    ASSERT_EQ(pair.server.socket.arrived.size(), 1U);
    EXPECT_EQ(pair.server.socket.arrived.front().payload.size(), size);
  }
}

// A byte takes 1 us. 3008 bytes behind IPv4's head are 1480, 1480 and 48: the host's port is
// through with them after 3008 us; the switch's has the second until 4440 us, then the third.
TEST(HostNetworkTest, ItArrivesWithTheLastOfThem) {
  scenarios::Scenario scenario = two_hosts();
  scenario.network.bandwidth_mbit_per_s = 8;
  scenario.network.latency_fixed_ms = 1;
  Pair pair(scenario);
  pair.server.socket.arrival_stamps = shim::kSoftwareStamps;
  pair.world.spawn(Pair::send(pair, kIpv4, 3000));
  pair.run(1);
  ASSERT_EQ(pair.arrivals_ms.size(), 1U);
  EXPECT_NEAR(pair.arrivals_ms[0], 4.488 + 1, 1e-6);
  const HostTime stamp = pair.world.hosts.clock(1).read(TrueTime(from_ms(5.488)));
  EXPECT_NEAR(static_cast<double>(pair.server.socket.arrived.front().arrival.system),
              static_cast<double>(epoch_ns(stamp)), 1);
}

// Each of the 45 is lost with 1 %: (1 - 0.01)^45 = 0.636 of the datagrams come.
TEST(HostNetworkTest, OneLostFragmentLosesTheDatagram) {
  scenarios::Scenario scenario = two_hosts();
  scenario.network.loss_probability = 0.01;
  Pair pair(scenario);
  constexpr int kSent = 400;
  int came = 0;
  for (int i = 0; i < kSent; ++i) {
    pair.world.spawn(Pair::send(pair, kIpv4, 65'507));
    pair.run(i + 1);
    came += static_cast<int>(pair.server.socket.arrived.size());
    while (!pair.server.socket.arrived.empty()) take_datagram(pair.server.socket, 0);
  }
  const double expected = std::pow(0.99, 45);
  const double sigma = std::sqrt(expected * (1 - expected) / kSent);
  EXPECT_NEAR(came / double{kSent}, expected, 4 * sigma) << "seed 1";
}

TEST(HostNetworkTest, OnlyTheFirstFragmentIsStamped) {
  Pair pair(two_hosts());
  pair.world.spawn(Pair::send(pair, kIpv4, 20'000, shim::kSoftwareStamps));
  pair.run(1);
  ASSERT_EQ(pair.client.socket.error_queue.size(), 1U);
  EXPECT_EQ(pair.client.socket.error_queue.front().payload.size(), 1472U);
  EXPECT_EQ(pair.client.socket.error_queue.front().arrival.origin, SO_EE_ORIGIN_TIMESTAMPING);
}

// icmp_ratelimit: six at once, then one a second, or four by IPv6.
TEST(HostNetworkTest, ClosedPortsAnswerAsOftenAsLinuxLetsThem) {
  for (const auto& [to, after_a_second] : {std::pair(kIpv4, 1), std::pair(kIpv6, 4)}) {
    Pair pair(two_hosts(), false);
    int refused = 0;
    pair.client.socket.ipv4.receives_errors = pair.client.socket.ipv6.receives_errors = true;
    const auto send_and_count = [&, to = to](int count, double until_s) {
      for (int i = 0; i < count; ++i) {
        pair.client.socket.error = 0;
        pair.world.spawn(Pair::send(pair, to, 10));
      }
      pair.run(until_s);
      refused = static_cast<int>(pair.client.socket.error_queue.size());
      pair.client.socket.error_queue.clear();
      pair.client.socket.error = 0;
    };
    send_and_count(10, 0.5);
    EXPECT_EQ(refused, 6);
    pair.run(1.0005);
    send_and_count(10, 1.2);
    EXPECT_EQ(refused, after_a_second);
  }
}

TEST(HostNetworkTest, ARefusalTakesAWayBack) {
  scenarios::Scenario scenario = two_hosts();
  scenario.network.latency_fixed_ms = 1;
  Pair pair(scenario, false);
  double heard_ms = 0;
  pair.client.socket.on_arrival = [&] { heard_ms = pair.world.now_ms(); };
  ASSERT_EQ(pair.client.network.connect(pair.client.socket, kIpv6), 0);
  pair.world.spawn(Pair::send(pair, kIpv6, 10));
  pair.run(1);
  EXPECT_NEAR(heard_ms, 2, 1e-6);
  EXPECT_EQ(readiness_of(pair.client.socket), POLLERR | POLLOUT);
  EXPECT_EQ(take_datagram(pair.client.socket, 0).error, ECONNREFUSED);
  EXPECT_EQ(take_datagram(pair.client.socket, 0).error, EAGAIN);
}

TEST(HostNetworkTest, AGroupOfIpv6IsLeftWithItsLastSocket) {
  Pair pair(two_hosts());
  shim::Address group{.host = shim::small_address(0x7777), .family = AF_INET6};
  group.host.bytes[0] = 0xFF;
  group.host.bytes[1] = 0x0E;
  Groups& groups = pair.world.hosts.network().groups();
  const Groups::Id id = Groups::of_ethernet(0x333300007777);
  UdpSocket second{.family = AF_INET6};
  HostNetwork& network = pair.server.network;
  network.open(second);
  ASSERT_EQ(network.join(pair.server.socket, true, 0, group), 0);
  ASSERT_EQ(network.join(second, true, 0, group), 0);
  EXPECT_TRUE(groups.members(id).contains(1));
  ASSERT_EQ(network.join(pair.server.socket, false, 0, group), 0);
  EXPECT_TRUE(groups.members(id).contains(1));
  network.close(second);
  EXPECT_FALSE(groups.members(id).contains(1));
}

// As many bytes as Linux keeps.
TEST(HostNetworkTest, ASocketHoldsAsMuchAsItsBuffer) {
  Pair pair(two_hosts());
  for (int i = 0; i < 10; ++i) pair.world.spawn(Pair::send(pair, kIpv4, 60'000));
  pair.run(1);
  EXPECT_EQ(pair.server.socket.arrived.size(), 4U) << "until there are 212992 bytes";
  while (!pair.server.socket.arrived.empty()) take_datagram(pair.server.socket, 0);
  for (int i = 0; i < 300; ++i) pair.world.spawn(Pair::send(pair, kIpv4, 1));
  pair.run(2);
  EXPECT_EQ(pair.server.socket.arrived.size(), UdpSocket::kMostQueued);
}

}  // namespace
}  // namespace simbench::sim
