#include "sim/network/link_latency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace simbench::sim {
namespace {

constexpr std::uint64_t kLatencySeed = 17;

// What a table replaces would be seen.
scenarios::Network tabled(std::vector<double> table) {
  scenarios::Network network{};
  network.latency_fixed_ms = 50;
  network.latency_exponential_ms = 50;
  network.spike_probability = 1;
  network.spike_max_ms = 50;
  network.latency_quantiles_ms = std::move(table);
  return network;
}

double draw_ms(LinkLatency& latency, std::uint64_t message) {
  RandomStream draw(kLatencySeed, "test", message);
  return to_ms(latency.draw(draw, TrueTime{}));
}

TEST(LinkLatency, OfAConstantTableIsItsValue) {
  const scenarios::Network network = tabled({0.25, 0.25, 0.25});
  LinkLatency latency(network, kLatencySeed, 0, 1, 0);
  for (std::uint64_t i = 0; i < 100; ++i) EXPECT_EQ(draw_ms(latency, i), 0.25);
  EXPECT_EQ(latency.cable(), from_ms(0.25));
}

TEST(LinkLatency, HasTheTablesDistribution) {
  constexpr std::uint64_t kDraws = 50'000;
  const scenarios::Network network = tabled({1, 2});
  LinkLatency latency(network, kLatencySeed, 0, 1, 0);
  std::vector<double> values;
  for (std::uint64_t i = 0; i < kDraws; ++i) values.push_back(draw_ms(latency, i) - 1);
  std::sort(values.begin(), values.end());
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double below = static_cast<double>(i) / kDraws;
    worst = std::max({worst, values[i] - below, below + 1.0 / kDraws - values[i]});
  }
  EXPECT_LT(worst, 1.95 / std::sqrt(kDraws)) << "Kolmogorov-Smirnov, seed " << kLatencySeed;
}

// The mean wait in an M/D/1 queue is r S / (2 (1 - r)): Pollaczek and Khinchine.
TEST(LinkLatency, WaitsForForeignTraffic) {
  scenarios::Network network{};
  network.bandwidth_mbit_per_s = 1000;
  network.cross_traffic_share = 0.6;
  network.switch_of_host = {0, 1};
  LinkLatency latency(network, kLatencySeed, 0, 1, 0);
  constexpr std::uint64_t kDraws = 50'000;
  double sum_ms = 0;
  int idle = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double ms = draw_ms(latency, i);
    sum_ms += ms;
    idle += ms == 0 ? 1 : 0;
  }
  const double frame_ms = 8 * 1538 / 1e6;
  const double mean_ms = 2 * 0.6 * frame_ms / (2 * (1 - 0.6));
  EXPECT_NEAR(sum_ms / kDraws / mean_ms, 1, 0.03) << "seed " << kLatencySeed;
  EXPECT_NEAR(1.0 * idle / kDraws, 0.4 * 0.4, 0.01) << "seed " << kLatencySeed;
}

TEST(LinkLatency, AsymmetryAndSessionAreAddedToATable) {
  scenarios::Network network = tabled({1, 1});
  network.asymmetry_sigma_ms = 0.2;
  LinkLatency forward(network, kLatencySeed, 0, 1, 3);
  LinkLatency backward(network, kLatencySeed, 1, 0, 3);
  const double there = draw_ms(forward, 0);
  const double back = draw_ms(backward, 0);
  EXPECT_NEAR(there + back, 2 * 4, 2e-6);
  EXPECT_GT(std::abs(there - back), 0);
  EXPECT_NEAR(to_ms(forward.cable()), there - 3, 2e-6);
}

// A network of fixed latencies alone.
scenarios::Network fixed_network(double latency_ms) {
  scenarios::Network network{};
  network.latency_fixed_ms = latency_ms;
  return network;
}

double first_ms(const scenarios::Network& network, PeerId from, PeerId to) {
  LinkLatency latency(network, kLatencySeed, from, to, 0);
  return draw_ms(latency, 0);
}

TEST(LinkLatency, AStatedLinkIsThatOfItsHostWithTheMaster) {
  scenarios::Network network = fixed_network(1);
  network.asymmetry_sigma_ms = 0.3;
  scenarios::Network stated = network;
  stated.links = {{.host = 2, .latency_fixed_ms = 5, .asymmetry_ms = 0.5}};
  EXPECT_NEAR(first_ms(stated, 0, 2), 5.25, 2e-6);
  EXPECT_NEAR(first_ms(stated, 2, 0), 4.75, 2e-6);
  for (const auto& [from, to] :
       {std::pair<PeerId, PeerId>{0, 1}, {1, 0}, {1, 2}, {2, 1}, {2, 3}, {3, 2}}) {
    EXPECT_EQ(first_ms(stated, from, to), first_ms(network, from, to)) << from << " to " << to;
  }
  stated.links = {{.host = 2}};
  EXPECT_EQ(first_ms(stated, 0, 2), first_ms(network, 0, 2)) << "what it does not state";
}

TEST(LinkLatency, OfAStatedLinkHasItsExponentialMean) {
  constexpr std::uint64_t kDraws = 50'000;
  scenarios::Network network = fixed_network(1);
  network.latency_exponential_ms = 7;
  network.links = {{.host = 1, .latency_exponential_ms = 2}};
  LinkLatency latency(network, kLatencySeed, 1, 0, 0);
  double sum_ms = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) sum_ms += draw_ms(latency, i);
  EXPECT_NEAR(sum_ms / kDraws, 1 + 2, 5 * 2 / std::sqrt(kDraws)) << "seed " << kLatencySeed;
}

TEST(LinkLatency, StatedAsymmetryIsAddedToATable) {
  scenarios::Network network = tabled({1, 1});
  network.asymmetry_sigma_ms = 0.2;
  network.links = {{.host = 1, .asymmetry_ms = -0.6}};
  EXPECT_NEAR(first_ms(network, 0, 1), 0.7, 2e-6);
  EXPECT_NEAR(first_ms(network, 1, 0), 1.3, 2e-6);
}

// The way from a to b less the way back.
double asymmetry_ms_of(const scenarios::Network& network, PeerId a, PeerId b) {
  return first_ms(network, a, b) - first_ms(network, b, a);
}

TEST(LinkLatency, AsymmetriesOfPortsAddUpAroundACircle) {
  scenarios::Network network = fixed_network(10);
  network.port_asymmetry_sigma_ms = 0.4;
  const double around_ms = asymmetry_ms_of(network, 0, 1) + asymmetry_ms_of(network, 1, 2) +
                           asymmetry_ms_of(network, 2, 0);
  EXPECT_NEAR(around_ms, 0, 1e-5);
  double squares = 0;
  constexpr PeerId kHosts = 2000;
  for (PeerId host = 1; host < kHosts; host += 2) {
    squares += std::pow(asymmetry_ms_of(network, host - 1, host), 2);
  }
  constexpr double kPairs = kHosts / 2.0;
  EXPECT_NEAR(std::sqrt(squares / kPairs), 0.4 * std::sqrt(2), 5 * 0.4 / std::sqrt(kPairs))
      << "seed " << kLatencySeed;
}

TEST(LinkLatency, PortsAddToLinksDrawnAndStated) {
  scenarios::Network ports = fixed_network(10);
  ports.port_asymmetry_sigma_ms = 0.4;
  scenarios::Network links = fixed_network(10);
  links.asymmetry_sigma_ms = 0.3;
  scenarios::Network both = links;
  both.port_asymmetry_sigma_ms = 0.4;
  const double of_ports_ms = asymmetry_ms_of(ports, 0, 1);
  EXPECT_NEAR(asymmetry_ms_of(both, 0, 1), of_ports_ms + asymmetry_ms_of(links, 0, 1), 5e-6);
  both.links = {{.host = 1, .asymmetry_ms = 0.25}};
  EXPECT_NEAR(asymmetry_ms_of(both, 0, 1), of_ports_ms + 0.25, 5e-6);
}

}  // namespace
}  // namespace simbench::sim
