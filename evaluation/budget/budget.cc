#include "evaluation/budget/budget.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "algorithms/ports/assert.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

// The scores of all worlds: by world, then by seed.
struct WorldScores {
  std::vector<std::vector<double>> set_amd_ms;
  std::vector<std::vector<double>> amd_ms;
  std::vector<std::vector<double>> set_absolute_error_ms;
  std::vector<std::vector<double>> absolute_error_ms;
  std::vector<std::vector<double>> physical_ms;
};

void add_world(const Row& row, WorldScores& scores) {
  std::vector<double> set_amd_ms;
  std::vector<double> set_absolute_error_ms;
  for (const SeedScore& seed : row.seeds) {
    set_amd_ms.push_back(seed.set_amd_ms);
    set_absolute_error_ms.push_back(seed.set_absolute_error_ms);
  }
  scores.set_amd_ms.push_back(std::move(set_amd_ms));
  scores.set_absolute_error_ms.push_back(std::move(set_absolute_error_ms));
  scores.amd_ms.push_back(row.amd_ms.values);
  scores.absolute_error_ms.push_back(row.absolute_error_ms.values);
  scores.physical_ms.push_back(row.exposure_spread_ms.values);
}

bool all_exist(const std::vector<std::vector<double>>& values) {
  return std::all_of(values.begin(), values.end(), [](const std::vector<double>& world) {
    return std::none_of(world.begin(), world.end(), [](double value) { return std::isnan(value); });
  });
}

void finish(BudgetPart& part) {
  part.mean = mean_of_existing(part.values);
  part.p05 = quantile(part.values, 0.05);
  part.p95 = quantile(part.values, 0.95);
}

ErrorParts divide(const std::vector<std::vector<double>>& by_world) {
  ErrorParts parts;
  const std::size_t seeds = by_world.front().size();
  std::vector<double> worth(by_world.size());
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    for (std::size_t world = 0; world < worth.size(); ++world) worth[world] = by_world[world][seed];
    const std::vector<double> values = shapley_values(worth);
    for (std::size_t stage = 0; stage < kStageCount; ++stage) {
      parts.stages[stage].values.push_back(values[stage]);
    }
    parts.total.values.push_back(worth.front());
    parts.remainder.values.push_back(worth.back());
  }
  for (BudgetPart& part : parts.stages) finish(part);
  finish(parts.total);
  finish(parts.remainder);
  return parts;
}

}  // namespace

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

Budget error_budget(const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline,
                    const WorldFactory& make_world, const EvaluationOptions& options,
                    const Progress& progress) {
  EvaluationOptions of_world = options;
  of_world.pipelines.clear();
  of_world.keep_pulses = false;
  WorldScores scores;
  for (std::size_t world = 0; world < StageSet::kSets; ++world) {
    const StageSet ideal(world);
    const scenarios::Scenario changed = ideal_scenario(scenario, pipeline, ideal);
    const std::uint64_t done_before = world * options.seeds;
    const Results results = evaluate(
        changed, [&] { return ideal_delivery(make_world(changed), changed, ideal); }, of_world,
        [&](std::uint64_t done, std::uint64_t) {
          if (progress) progress(done_before + done, StageSet::kSets * options.seeds);
        });
    add_world(results.rows.front(), scores);
  }
  Budget budget;
  budget.pipeline = pipeline.name;
  budget.amd_of_sets = all_exist(scores.set_amd_ms);
  budget.amd_ms = divide(budget.amd_of_sets ? scores.set_amd_ms : scores.amd_ms);
  budget.absolute_error_ms =
      divide(budget.amd_of_sets ? scores.set_absolute_error_ms : scores.absolute_error_ms);
  budget.physical_ms = divide(scores.physical_ms);
  return budget;
}

}  // namespace simbench::evaluation
