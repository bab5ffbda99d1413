#include "sim/traffic/traffic.h"

#include <gtest/gtest.h>

#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr std::uint64_t kTrafficSeed = 21;
using scenarios::TrafficKind;

scenarios::Network loaded_network(std::vector<scenarios::Traffic> traffic) {
  scenarios::Network network;
  network.bandwidth_mbit_per_s = 1000;
  network.latency_fixed_ms = 0.005;
  network.buffer_kb = 128;
  network.traffic = std::move(traffic);
  return network;
}

TEST(TrafficTest, NoneIsNone) {
  CrossTraffic traffic(loaded_network({}), {}, kTrafficSeed, 3);
  EXPECT_TRUE(traffic.is_none());
  EXPECT_EQ(traffic.at_host(0, at_ms(1)).in_queue, Nanoseconds(0));
  EXPECT_EQ(traffic.at_switch(2, at_ms(1)).wait, Nanoseconds(0));
  EXPECT_EQ(traffic.at_switch(2, at_ms(1)).loss_share, 0);
  EXPECT_EQ(traffic.at_trunk(0, true, at_ms(1)).wait, Nanoseconds(0));
}

TEST(TrafficTest, TheOwnHostsBacklogLiesInRingAndQueue) {
  scenarios::Hosts hosts;
  hosts.send_queue = scenarios::SendQueue{
      .discipline = scenarios::QueueDiscipline::kPfifoFast, .ring_kb = 30, .connection_kb = 100};
  const scenarios::Network network =
      loaded_network({{.kind = TrafficKind::kTcp, .from = 0, .to = 1}});
  CrossTraffic fifo(network, hosts, kTrafficSeed, 3);
  EXPECT_NEAR(1e3 * to_ms(fifo.at_host(0, at_ms(5000)).in_ring), 240, 0.1);
  EXPECT_NEAR(1e3 * to_ms(fifo.at_host(0, at_ms(5000)).in_queue), 560, 2);
  EXPECT_EQ(fifo.at_host(2, at_ms(5000)).in_ring, Nanoseconds(0));
  hosts.send_queue->discipline = scenarios::QueueDiscipline::kFqCodel;
  CrossTraffic fair(network, hosts, kTrafficSeed, 3);
  EXPECT_NEAR(1e3 * to_ms(fair.at_host(0, at_ms(5000)).in_ring), 240, 0.1);
  EXPECT_EQ(fair.at_host(0, at_ms(5000)).in_queue, Nanoseconds(0));
}

TEST(TrafficTest, StreamsPassTheTrunksBetweenTheirSwitches) {
  scenarios::Network network = loaded_network(
      {{.kind = TrafficKind::kPaced, .from = 0, .to = 2, .mbit_per_s = 990, .burst_kb = 64}});
  network.switch_of_host = {0, 1, 2};
  CrossTraffic traffic(network, {}, kTrafficSeed, 3);
  const auto longest = [&](auto wait_at) {
    Nanoseconds most{0};
    for (int i = 0; i < 500; ++i) most = std::max(most, wait_at(at_ms(10 + 0.1 * i)));
    return most;
  };
  EXPECT_GT(longest([&](TrueTime t) { return traffic.at_trunk(0, true, t).wait; }), Nanoseconds(0));
  EXPECT_GT(longest([&](TrueTime t) { return traffic.at_trunk(1, true, t).wait; }), Nanoseconds(0));
  EXPECT_GT(longest([&](TrueTime t) { return traffic.at_switch(2, t).wait; }), Nanoseconds(0));
  EXPECT_EQ(longest([&](TrueTime t) { return traffic.at_trunk(2, false, t).wait; }),
            Nanoseconds(0));
  EXPECT_EQ(longest([&](TrueTime t) { return traffic.at_switch(1, t).wait; }), Nanoseconds(0));
}

TEST(TrafficTest, BothWaysLoadsBothHosts) {
  CrossTraffic traffic(
      loaded_network({{.kind = TrafficKind::kTcp, .from = 0, .to = 1, .both_ways = true}}), {},
      kTrafficSeed, 2);
  EXPECT_GT(traffic.at_host(0, at_ms(5000)).in_queue, from_us(400));
  EXPECT_GT(traffic.at_host(1, at_ms(5000)).in_queue, from_us(400));
}

TEST(TrafficTest, TcpTakesWhatStreamsLeave) {
  CrossTraffic traffic(
      loaded_network({{.kind = TrafficKind::kTcp, .from = 0, .to = 2},
                      {.kind = TrafficKind::kPaced, .from = 1, .to = 2, .mbit_per_s = 500}}),
      {}, kTrafficSeed, 3);
  // Its queue now stands in the switch, not in its host.
  EXPECT_EQ(traffic.at_host(0, at_ms(5000)).in_queue, Nanoseconds(0));
  EXPECT_GT(traffic.at_switch(2, at_ms(5000)).wait, from_us(400));
}

// Each minute has numbers of its own: whoever asks in one alone finds the same.
TEST(TrafficTest, AMinuteDoesNotDependOnTheMinutesBefore) {
  const scenarios::Network network =
      loaded_network({{.kind = TrafficKind::kTcp, .from = 0, .to = 2},
                      {.kind = TrafficKind::kTcp, .from = 1, .to = 2}});
  CrossTraffic often(network, {}, kTrafficSeed, 3);
  CrossTraffic once(network, {}, kTrafficSeed, 3);
  Nanoseconds last{};
  for (int second = -90; second <= 200; ++second)
    last = often.at_switch(2, at_ms(1e3 * second)).wait;
  EXPECT_EQ(once.at_switch(2, at_ms(200e3)).wait, last);
  EXPECT_GT(last, from_us(400));
}

TEST(TrafficTest, ALateQuestionOfTheMinuteBeforeIsAnswered) {
  CrossTraffic traffic(loaded_network({{.kind = TrafficKind::kTcp, .from = 0, .to = 2},
                                       {.kind = TrafficKind::kTcp, .from = 1, .to = 2}}),
                       {}, kTrafficSeed, 3);
  EXPECT_GT(traffic.at_switch(2, at_ms(60'000.1)).wait, from_us(400));
  EXPECT_GT(traffic.at_switch(2, at_ms(59'999.9)).wait, from_us(400));
}

}  // namespace
}  // namespace simbench::sim
