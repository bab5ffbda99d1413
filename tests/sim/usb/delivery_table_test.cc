// Delays drawn from a table: their distribution, their correlation, and what the table replaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "sim/usb/host_stack.h"

namespace simbench::sim {
namespace {

// Quantiles of Exp(mean_ms), cut off at the probability 1 - 1 / 2000.
std::vector<double> exponential_table(double mean_ms) {
  std::vector<double> table;
  for (int i = 0; i <= 1000; ++i) {
    table.push_back(-mean_ms * std::log1p(-std::min(i / 1000.0, 1 - 1 / 2000.0)));
  }
  return table;
}

// What the table leaves unused would be seen.
scenarios::Usb tabled_usb(std::vector<double> table, double correlation) {
  scenarios::Usb usb{};
  usb.kernel_copy_exponential_ms = 50;
  usb.delivery_jitter_transfers = 50;
  usb.spike_probability = 1;
  usb.spike_max_transfers = 50;
  usb.delivery_quantiles_ms = std::move(table);
  usb.delivery_correlation = correlation;
  return usb;
}

std::vector<double> draws_ms(const scenarios::Usb& usb, int count, std::uint64_t seed) {
  FrameDelays delays(usb, seed, 0);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const FrameDelays::Draw draw = delays.draw(2e6);
    EXPECT_EQ(draw.kernel_copy_ns, 0);
    values.push_back(draw.delivery_ns * 1e-6);
  }
  return values;
}

// Largest distance between the share of values below x and x in [0, 1].
double distance_to_uniform(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto rank = static_cast<double>(i);
    worst = std::max({worst, values[i] - rank / n, (rank + 1) / n - values[i]});
  }
  return worst;
}

// Between each value and the next, of their ranks.
double rank_correlation(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    rank[order[i]] = (static_cast<double>(i) + 0.5) / static_cast<double>(order.size()) - 0.5;
  }
  double product = 0;
  for (std::size_t i = 1; i < rank.size(); ++i) product += rank[i - 1] * rank[i];
  return 12 * product / static_cast<double>(rank.size() - 1);
}

TEST(DeliveryTable, ReplacesCopyJitterAndSpikes) {
  for (const double delay : draws_ms(tabled_usb({0.25, 0.25}, 0), 100, 1)) EXPECT_EQ(delay, 0.25);
}

TEST(DeliveryTable, HasTheTablesDistribution) {
  constexpr int kDraws = 100'000;
  constexpr double kCritical = 1.95;  // of sqrt(n) times the distance: 1 in 1000
  const double limit = kCritical / std::sqrt(kDraws);
  EXPECT_LT(distance_to_uniform(draws_ms(tabled_usb({0, 1}, 0), kDraws, 7)), limit) << "seed 7";

  std::vector<double> probabilities = draws_ms(tabled_usb(exponential_table(0.3), 0), kDraws, 8);
  for (double& value : probabilities) value = -std::expm1(-value / 0.3);
  // The last cell is a line to where the table is cut off.
  EXPECT_LT(distance_to_uniform(probabilities), limit + 0.001) << "seed 8";
}

TEST(DeliveryTable, CorrelationLeavesTheDistributionAlone) {
  constexpr int kDraws = 100'000;
  // An AR(1) of 0.8 has an effective size of n (1 - 0.8) / (1 + 0.8).
  const double limit = 1.95 / std::sqrt(kDraws / 9.0);
  EXPECT_LT(distance_to_uniform(draws_ms(tabled_usb({0, 1}, 0.8), kDraws, 9)), limit) << "seed 9";
}

TEST(DeliveryTable, HasTheRankCorrelationOfItsCopula) {
  constexpr int kDraws = 100'000;
  for (const double correlation : {-0.5, 0.0, 0.3, 0.8}) {
    const scenarios::Usb usb = tabled_usb(exponential_table(0.3), correlation);
    const double expected = 6 / std::numbers::pi * std::asin(correlation / 2);
    // Bartlett: of an AR(1)'s lag-1 correlation, sqrt((1 - r^2) / n); of ranks a little more.
    EXPECT_NEAR(rank_correlation(draws_ms(usb, kDraws, 11)), expected, 5 / std::sqrt(kDraws))
        << "correlation " << correlation << ", seed 11";
  }
}

TEST(DeliveryTable, DrawsOfOneSeedMoveTogether) {
  const std::vector<double> narrow = draws_ms(tabled_usb({0, 1}, 0.4), 100, 3);
  const std::vector<double> wide = draws_ms(tabled_usb({0, 2}, 0.4), 100, 3);
  for (std::size_t i = 0; i < narrow.size(); ++i) EXPECT_DOUBLE_EQ(wide[i], 2 * narrow[i]);
}

}  // namespace
}  // namespace simbench::sim
