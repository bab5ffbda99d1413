#include "sim/network/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/sim/network/probe.h"

namespace simbench::sim {
namespace {

// 1250 bytes at 100 Mbit/s: 0.1 ms on each of the wires to, between and from three switches.
TEST(NetworkTest, SwitchesInALinePassMessagesOn) {
  scenarios::Network parameters = plain_network();
  parameters.bandwidth_mbit_per_s = 100;
  parameters.switch_of_host = {0, 2, 0, 1, 2, 2, 2, 2};
  parameters.switch_residence_ms = 0.01;
  World world(parameters);
  Probe& to_far = world.probe(0, 1);
  Probe& far = world.probe(1, 0);
  Probe& to_near = world.probe(0, 2);
  Probe& near = world.probe(2, 0);
  world.send_at(0, to_far, 1, 1250);
  world.send_at(10, to_near, 2, 1250);
  world.send_at(20, far, 3, 1250);
  world.run();
  ASSERT_EQ(far.arrived.size(), 1u);
  EXPECT_NEAR(far.arrived[0].at_ms, 4 * 0.1 + 3 * 0.01 + 1, 1e-6);
  ASSERT_EQ(near.arrived.size(), 1u);
  EXPECT_NEAR(near.arrived[0].at_ms, 10 + 2 * 0.1 + 0.01 + 1, 1e-6);
  ASSERT_EQ(to_far.arrived.size(), 1u);
  EXPECT_NEAR(to_far.arrived[0].at_ms, 20 + 4 * 0.1 + 3 * 0.01 + 1, 1e-6);
}

// 1250 bytes at 100 Mbit/s: 0.1 ms on each wire. Sent one by one they would queue on the sender's
// port and on the trunks.
TEST(NetworkTest, AMessageToAGroupPassesEachPortOnce) {
  scenarios::Network parameters = plain_network();
  parameters.bandwidth_mbit_per_s = 100;
  parameters.switch_of_host = {1, 1, 1, 0, 2, 2, 3, 3};
  World world(parameters);
  std::vector<Probe*> senders;
  std::vector<Probe*> members;
  for (const PeerId to : {1u, 2u, 3u, 4u, 5u, 6u}) {
    senders.push_back(&world.probe(0, to, Transport::kDatagram));
    members.push_back(&world.probe(to, 0, Transport::kDatagram));
  }
  Probe& outside = world.probe(7, 0, Transport::kDatagram);
  world.probe(0, 7, Transport::kDatagram);
  world.send_to_group_at(0, *senders[0], senders, 9, 1250);
  world.run();
  const std::vector<double> expected_ms = {1.2, 1.2, 1.3, 1.3, 1.3, 1.4};
  for (std::size_t i = 0; i < members.size(); ++i) {
    ASSERT_EQ(numbers(members[i]->arrived), std::vector<std::uint8_t>{9}) << "member " << i;
    EXPECT_NEAR(members[i]->arrived[0].at_ms, expected_ms[i], 1e-6) << "member " << i;
  }
  EXPECT_TRUE(outside.arrived.empty());
  EXPECT_EQ(senders[0]->left_ms, std::vector<double>{0});
}

TEST(NetworkTest, CopiesForAGroupHaveTheDrawsOfTheirOwnPaths) {
  scenarios::Network parameters = plain_network();
  parameters.latency_exponential_ms = 5;
  std::vector<std::vector<double>> at_ms;
  for (const bool at_once : {false, true}) {
    World world(parameters);
    std::vector<Probe*> senders;
    std::vector<Probe*> members;
    for (const PeerId to : {1u, 2u}) {
      senders.push_back(&world.probe(0, to, Transport::kDatagram));
      members.push_back(&world.probe(to, 0, Transport::kDatagram));
    }
    if (at_once) {
      world.send_to_group_at(3, *senders[0], senders, 1, 10);
    } else {
      for (Probe* each : senders) world.send_at(3, *each, 1, 10);
    }
    world.run();
    for (const Probe* each : members) at_ms.push_back(times(each->arrived));
  }
  EXPECT_NE(at_ms[0], at_ms[1]) << "seed " << kNetworkSeed;
  EXPECT_EQ(at_ms[2], at_ms[0]) << "seed " << kNetworkSeed;
  EXPECT_EQ(at_ms[3], at_ms[1]) << "seed " << kNetworkSeed;
}

TEST(NetworkTest, TrunksQueueWhatSharesThem) {
  scenarios::Network parameters = plain_network();
  parameters.bandwidth_mbit_per_s = 100;
  parameters.switch_of_host = {0, 1, 0, 1, 1, 1, 1, 1};
  World world(parameters);
  Probe& first = world.probe(0, 1);
  Probe& at_1 = world.probe(1, 0);
  Probe& second = world.probe(2, 3);
  Probe& at_3 = world.probe(3, 2);
  world.send_at(0, first, 1, 1250);
  world.send_at(0, second, 2, 1250);
  world.run();
  EXPECT_NEAR(at_1.arrived.at(0).at_ms, 3 * 0.1 + 1, 1e-6);
  EXPECT_NEAR(at_3.arrived.at(0).at_ms, 4 * 0.1 + 1, 1e-6) << "behind the other on the trunk";
}

TEST(NetworkTest, FixedLatencyInBothDirections) {
  World world(plain_network());
  Probe& a = world.probe(0, 1);
  Probe& b = world.probe(1, 0);
  world.send_at(5, a, 1);
  world.send_at(7, b, 2);
  world.run();
  ASSERT_EQ(times(b.arrived), std::vector<double>{6});
  ASSERT_EQ(times(a.arrived), std::vector<double>{8});
  EXPECT_EQ(a.left_ms, std::vector<double>{5});
}

TEST(NetworkTest, AsymmetryIsTheDifferenceOfTheDirectionsAndKeepsTheirSum) {
  scenarios::Network network = plain_network();
  network.asymmetry_sigma_ms = 0.1;
  double squares = 0;
  constexpr int kLinks = 400;
  for (std::uint64_t seed = 1; seed <= kLinks; ++seed) {
    World world(network, seed);
    Probe& a = world.probe(0, 1);
    Probe& b = world.probe(1, 0);
    world.send_at(0, a, 1);
    world.send_at(0, b, 2);
    world.run();
    const double forward_ms = b.arrived.at(0).at_ms;
    const double backward_ms = a.arrived.at(0).at_ms;
    ASSERT_NEAR(forward_ms + backward_ms, 2, 3e-6) << "seed " << seed;
    squares += (forward_ms - backward_ms) * (forward_ms - backward_ms);
  }
  EXPECT_NEAR(std::sqrt(squares / kLinks), 0.1, 0.1 * 5 / std::sqrt(2.0 * kLinks));
}

TEST(NetworkTest, PortsServeInOrderOfArrival) {
  scenarios::Network network = plain_network();
  network.bandwidth_mbit_per_s = 8;  // 1 us per byte
  network.overhead_bytes = 100;
  World world(network);
  Probe& from0 = world.probe(0, 2);
  Probe& from1 = world.probe(1, 2);
  Probe& at2_from0 = world.probe(2, 0);
  Probe& at2_from1 = world.probe(2, 1);
  // 1 ms each on the host's port and on the switch's towards host 2.
  world.send_at(0, from0, 1, 900);
  world.send_at(0, from0, 2, 900);    // leaves host 0's port at 2 ms
  world.send_at(0.5, from1, 3, 900);  // reaches the switch at 1.5 ms: between 1 and 2
  world.run();
  EXPECT_EQ(times(at2_from0.arrived), (std::vector<double>{1 + 1 + 1, 4 + 1}));
  EXPECT_EQ(times(at2_from1.arrived), (std::vector<double>{3 + 1}));
}

TEST(NetworkTest, OtherPortsAreNotHeldUp) {
  scenarios::Network network = plain_network();
  network.bandwidth_mbit_per_s = 8;
  World world(network);
  Probe& busy = world.probe(0, 1);
  Probe& other = world.probe(2, 3);
  Probe& at3 = world.probe(3, 2);
  world.probe(1, 0);
  world.send_at(0, busy, 1, 1'000'000);
  world.send_at(0, other, 2, 1000);
  world.run();
  EXPECT_EQ(times(at3.arrived), std::vector<double>{1 + 1 + 1});
}

TEST(NetworkTest, StreamsKeepTheirOrder) {
  scenarios::Network network = plain_network();
  network.latency_exponential_ms = 5;
  World world(network);
  Probe& a = world.probe(0, 1);
  Probe& b = world.probe(1, 0);
  for (int i = 0; i < 200; ++i) world.send_at(i * 0.1, a, static_cast<std::uint8_t>(i));
  world.run();
  ASSERT_EQ(b.arrived.size(), 200u);
  for (std::size_t i = 0; i < 200; ++i) ASSERT_EQ(b.arrived[i].number, i);
}

TEST(NetworkTest, ALostSegmentHoldsUpWhatFollowsIt) {
  scenarios::Network network = plain_network();
  network.loss_probability = 0.2;
  World world(network);
  Probe& a = world.probe(0, 1);
  Probe& b = world.probe(1, 0);
  for (int i = 0; i < 250; ++i) world.send_at(i * 10, a, static_cast<std::uint8_t>(i));
  world.run();
  ASSERT_EQ(b.arrived.size(), 250u);
  int delayed_by_one_timeout = 0;
  double held_until_ms = 0;
  for (int i = 0; i < 250; ++i) {
    const Seen& message = b.arrived[static_cast<std::size_t>(i)];
    ASSERT_EQ(message.number, i) << "seed " << kNetworkSeed;
    // Its own delay is 0, 200, 200 + 400 ... ms, or it arrives with one before it.
    const double own_ms = message.at_ms - i * 10 - 1;
    if (message.at_ms > held_until_ms) {
      held_until_ms = message.at_ms;
      const double timeouts = std::log2(own_ms / 200 + 1);
      ASSERT_NEAR(timeouts, std::round(timeouts), 1e-6) << own_ms << " ms, seed " << kNetworkSeed;
      if (timeouts > 0.5) ++delayed_by_one_timeout;
    } else {
      ASSERT_EQ(message.at_ms, held_until_ms);
    }
  }
  EXPECT_GT(delayed_by_one_timeout, 3);
}

TEST(NetworkTest, DatagramsAreLostDuplicatedAndReorderedAtTheirRates) {
  scenarios::Network network = plain_network();
  network.loss_probability = 0.1;
  network.duplicate_probability = 0.05;
  network.reorder_probability = 0.02;
  network.reorder_max_ms = 0.9;
  constexpr int kMessages = 20'000;
  World world(network);
  Probe& a = world.probe(0, 1, Transport::kDatagram);
  Probe& b = world.probe(1, 0, Transport::kDatagram);
  for (int i = 0; i < kMessages; ++i) world.send_at(i, a, static_cast<std::uint8_t>(i % 256));
  world.run();
  std::vector<int> copies(kMessages, 0);
  int late = 0;
  for (const Seen& message : b.arrived) {
    const double sent_ms = std::floor(message.at_ms - 1 + 1e-9);
    ++copies.at(static_cast<std::size_t>(sent_ms));
    if (message.at_ms - 1 - sent_ms > 1e-9) ++late;
  }
  const auto count = [&](int n) {
    return static_cast<double>(std::count(copies.begin(), copies.end(), n));
  };
  const auto expect_rate = [&](double seen, double p, const char* what) {
    EXPECT_NEAR(seen / kMessages, p, 5 * std::sqrt(p * (1 - p) / kMessages))
        << what << ", seed " << kNetworkSeed;
  };
  expect_rate(count(0), 0.1, "lost");
  expect_rate(count(2), 0.9 * 0.05, "duplicated");
  expect_rate(late, 0.9 * 0.02, "reordered");
}

TEST(NetworkTest, AReorderedDatagramIsOvertaken) {
  scenarios::Network network = plain_network();
  network.reorder_probability = 0.5;
  network.reorder_max_ms = 100;
  World world(network);
  Probe& a = world.probe(0, 1, Transport::kDatagram);
  Probe& b = world.probe(1, 0, Transport::kDatagram);
  for (int i = 0; i < 100; ++i) world.send_at(i, a, static_cast<std::uint8_t>(i));
  world.run();
  std::vector<std::uint8_t> order = numbers(b.arrived);
  ASSERT_EQ(order.size(), 100u);
  EXPECT_FALSE(std::is_sorted(order.begin(), order.end()));
  std::sort(order.begin(), order.end());
  EXPECT_EQ(std::unique(order.begin(), order.end()), order.end());
}

TEST(NetworkTest, DatagramsOtherwiseKeepTheirOrder) {
  scenarios::Network network = plain_network();
  network.latency_exponential_ms = 5;
  World world(network);
  Probe& a = world.probe(0, 1, Transport::kDatagram);
  Probe& b = world.probe(1, 0, Transport::kDatagram);
  for (int i = 0; i < 200; ++i) world.send_at(i * 0.1, a, static_cast<std::uint8_t>(i));
  world.run();
  const std::vector<std::uint8_t> order = numbers(b.arrived);
  EXPECT_EQ(order.size(), 200u);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(NetworkTest, LatencyHasTheMeanOfItsParts) {
  scenarios::Network network = plain_network();
  network.latency_fixed_ms = 0.1;
  network.latency_exponential_ms = 0.05;
  network.spike_probability = 0.1;
  network.spike_max_ms = 2;
  constexpr int kMessages = 20'000;
  World world(network);
  Probe& a = world.probe(0, 1);
  Probe& b = world.probe(1, 0);
  for (int i = 0; i < kMessages; ++i) world.send_at(i * 100, a, 1);
  world.run();
  double sum_ms = 0;
  for (int i = 0; i < kMessages; ++i) {
    const double latency_ms = b.arrived.at(static_cast<std::size_t>(i)).at_ms - i * 100;
    ASSERT_GE(latency_ms, 0.1 - 1e-6);
    sum_ms += latency_ms;
  }
  // Variance: 0.05^2, and of the spike p max^2 / 3 - (p max / 2)^2.
  const double sigma_ms = std::sqrt(0.0025 + 0.1 * 4 / 3 - 0.01);
  EXPECT_NEAR(sum_ms / kMessages, 0.1 + 0.05 + 0.1, 5 * sigma_ms / std::sqrt(kMessages))
      << "seed " << kNetworkSeed;
}

// A sender that sends more on one link, or on the other transport of the same link, moves nobody
// else's numbers.
TEST(NetworkTest, DrawsAreKeyedByLinkDirectionAndMessage) {
  scenarios::Network network = plain_network();
  network.latency_exponential_ms = 0.2;
  network.spike_probability = 0.1;
  network.spike_max_ms = 5;
  network.loss_probability = 0.05;
  network.burst = {.rate_hz = 5, .duration_exponential_ms = 20, .latency_ms = 3};
  const auto arrivals = [&](int extra) {
    World world(network);
    Probe& a = world.probe(0, 1);
    Probe& b = world.probe(1, 0);
    Probe& other = world.probe(0, 2);
    Probe& datagrams = world.probe(0, 1, Transport::kDatagram);
    world.probe(2, 0);
    world.probe(1, 0, Transport::kDatagram);
    for (int i = 0; i < 100; ++i) {
      for (int k = 0; k < extra; ++k) {
        world.send_at(i * 10, other, 9);
        world.send_at(i * 10, datagrams, 9);
        world.send_at(i * 10 + 1, b, 9);
      }
      world.send_at(i * 10, a, 1);
    }
    world.run();
    return times(b.arrived);
  };
  EXPECT_EQ(arrivals(0), arrivals(7));
}

TEST(NetworkTest, MessagesWaitForAReceiverThatOpensLate) {
  Engine engine;
  const scenarios::Network parameters = plain_network();
  const RunLoad load(kNetworkSeed, "load", scenarios::Hosts{}, parameters);
  const Outages outages(std::vector<scenarios::Fault>{});
  SimNetwork network(engine, parameters, kNetworkSeed, 2, load, outages);
  Probe a(network, engine, 0, 1, Transport::kStream);
  a.send(1);
  engine.run();
  Probe b(network, engine, 1, 0, Transport::kStream);
  b.on_arrival();
  EXPECT_EQ(times(b.arrived), std::vector<double>{1});
}

TEST(NetworkTest, SessionLoadIsCommonToBothEndsAndToNothingElse) {
  scenarios::Network network = plain_network();
  network.latency_session_exponential_ms = 2;
  scenarios::Hosts hosts{};
  hosts.send_cost_session_exponential_ms = 3;
  hosts.clock.set_cost_session_log_sigma = 0.2;
  hosts.load_log_sigma = 0.6;
  const RunLoad load(kNetworkSeed, "both@world", hosts, network);
  EXPECT_NE(load.session(0, 1).send_cost_ms, load.session(1, 0).send_cost_ms);
  EXPECT_EQ(load.session(0, 1).latency_ms, load.session(1, 0).latency_ms);
  EXPECT_NE(load.session(0, 1).send_cost_ms, load.session(0, 2).send_cost_ms);
  EXPECT_NE(load.set_cost_factor(0), load.set_cost_factor(1));
  EXPECT_NE(load.factor(), RunLoad(kNetworkSeed, "time@world", hosts, network).factor());
}

TEST(NetworkTest, SessionOccupancyIsExponentialTimesTheRunsFactor) {
  scenarios::Hosts hosts{};
  hosts.send_cost_session_exponential_ms = 3;
  hosts.load_log_sigma = 0.6;
  constexpr int kSeeds = 20'000;
  double sum = 0;
  double log_squares = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RunLoad load(seed, "both@world", hosts, plain_network());
    sum += load.session(0, 1).send_cost_ms / load.factor();
    log_squares += std::log(load.factor()) * std::log(load.factor());
  }
  EXPECT_NEAR(sum / kSeeds, 3, 5 * 3 / std::sqrt(kSeeds));
  EXPECT_NEAR(std::sqrt(log_squares / kSeeds), 0.6, 5 * 0.6 / std::sqrt(2.0 * kSeeds));
}

}  // namespace
}  // namespace simbench::sim
