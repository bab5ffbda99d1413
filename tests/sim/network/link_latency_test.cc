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

}  // namespace
}  // namespace simbench::sim
