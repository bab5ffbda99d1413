#include "evaluation/budget/shapley.h"

#include <bit>
#include <cstddef>
#include <utility>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {

std::vector<double> shapley_values(std::span<const double> worth) {
  SIMBENCH_ASSERT(std::has_single_bit(worth.size()), "a worth for each of 2^n coalitions");
  const auto players = static_cast<std::size_t>(std::countr_zero(worth.size()));
  // The share of orders in which exactly these k players come before a given one: k!(n-k-1)!/n!.
  std::vector<double> share(players);
  double choices = 1;  // of k players among the other n - 1
  for (std::size_t before = 0; before < players; ++before) {
    share[before] = 1 / (static_cast<double>(players) * choices);
    choices *= static_cast<double>(players - 1 - before) / static_cast<double>(before + 1);
  }
  std::vector<double> values(players, 0.0);
  for (std::size_t coalition = 0; coalition < worth.size(); ++coalition) {
    for (std::size_t player = 0; player < players; ++player) {
      const std::size_t joined = coalition | (std::size_t{1} << player);
      if (joined == coalition) continue;
      const auto before = static_cast<std::size_t>(std::popcount(coalition));
      values[player] += share[before] * (worth[coalition] - worth[joined]);
    }
  }
  return values;
}

BudgetPart budget_part(std::vector<double> values) {
  BudgetPart part{.values = std::move(values)};
  part.mean = mean_of_existing(part.values);
  part.p05 = quantile(part.values, 0.05);
  part.p95 = quantile(part.values, 0.95);
  return part;
}

DividedError divide_error(const std::vector<std::vector<double>>& by_world) {
  const std::size_t seeds = by_world.front().size();
  std::vector<std::vector<double>> players(
      static_cast<std::size_t>(std::countr_zero(by_world.size())));
  std::vector<double> worth(by_world.size());
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    for (std::size_t world = 0; world < worth.size(); ++world) worth[world] = by_world[world][seed];
    const std::vector<double> values = shapley_values(worth);
    for (std::size_t i = 0; i < players.size(); ++i) players[i].push_back(values[i]);
  }
  DividedError divided{.total = budget_part(by_world.front()),
                       .players = {},
                       .remainder = budget_part(by_world.back())};
  divided.players.reserve(players.size());
  for (std::vector<double>& values : players) {
    divided.players.push_back(budget_part(std::move(values)));
  }
  return divided;
}

}  // namespace simbench::evaluation
