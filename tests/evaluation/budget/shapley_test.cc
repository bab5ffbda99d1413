#include "evaluation/budget/shapley.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cstddef>
#include <numeric>
#include <vector>

namespace simbench::evaluation {
namespace {

TEST(Shapley, IndependentErrorsKeepTheirOwn) {
  const std::vector<double> own = {1, 2, 4};
  std::vector<double> worth(8);
  for (std::size_t ideal = 0; ideal < worth.size(); ++ideal) {
    for (std::size_t player = 0; player < own.size(); ++player) {
      if ((ideal >> player & 1U) == 0) worth[ideal] += own[player];
    }
  }
  const std::vector<double> values = shapley_values(worth);
  for (std::size_t player = 0; player < own.size(); ++player) {
    EXPECT_NEAR(values[player], own[player], 1e-12);
  }
}

TEST(Shapley, EqualOnesShareAndDummiesGetNothing) {
  // The error is there while player 0 or player 1 is real; player 2 does nothing.
  std::vector<double> worth(8);
  for (std::size_t ideal = 0; ideal < worth.size(); ++ideal)
    worth[ideal] = (ideal & 3U) == 3 ? 0 : 6;
  const std::vector<double> values = shapley_values(worth);
  EXPECT_NEAR(values[0], 3, 1e-12);
  EXPECT_NEAR(values[1], 3, 1e-12);
  EXPECT_NEAR(values[2], 0, 1e-12);
}

// The definition: what each player takes off when it joins, averaged over all orders.
std::vector<double> by_all_orders(const std::vector<double>& worth, std::size_t players) {
  std::vector<std::size_t> order(players);
  std::iota(order.begin(), order.end(), 0U);
  std::vector<double> values(players, 0.0);
  double orders = 0;
  do {
    std::size_t coalition = 0;
    for (const std::size_t player : order) {
      const std::size_t joined = coalition | (std::size_t{1} << player);
      values[player] += worth[coalition] - worth[joined];
      coalition = joined;
    }
    ++orders;
  } while (std::next_permutation(order.begin(), order.end()));
  for (double& value : values) value /= orders;
  return values;
}

TEST(Shapley, IsTheMeanOverAllOrders) {
  constexpr unsigned kSeed = 3;
  constexpr std::size_t kPlayers = 5;
  boost::random::mt19937_64 engine(kSeed);
  boost::random::uniform_real_distribution<double> draw(-1, 1);
  std::vector<double> worth(std::size_t{1} << kPlayers);
  for (double& value : worth) value = draw(engine);
  const std::vector<double> values = shapley_values(worth);
  const std::vector<double> expected = by_all_orders(worth, kPlayers);
  for (std::size_t player = 0; player < kPlayers; ++player) {
    EXPECT_NEAR(values[player], expected[player], 1e-12) << "seed " << kSeed;
  }
}

// Seed 1: two independent errors of 1 and 2, and 4 that remain. Seed 2: half of each.
TEST(Shapley, DividesEachSeedAndTheMean) {
  const DividedError divided = divide_error({{7, 3.5}, {6, 3}, {5, 2.5}, {4, 2}});
  EXPECT_EQ(divided.total.values, (std::vector<double>{7, 3.5}));
  EXPECT_EQ(divided.remainder.values, (std::vector<double>{4, 2}));
  ASSERT_EQ(divided.players.size(), 2U);
  EXPECT_EQ(divided.players[0].values, (std::vector<double>{1, 0.5}));
  EXPECT_EQ(divided.players[1].values, (std::vector<double>{2, 1}));
  EXPECT_DOUBLE_EQ(divided.players[1].mean, 1.5);
  EXPECT_DOUBLE_EQ(divided.players[1].p05, 1.05);
}

}  // namespace
}  // namespace simbench::evaluation
