#include "app/answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/interrupt.h"
#include "evaluation/budget/budget.h"
#include "reports/results/results_answer.h"
#include "scenarios/loader.h"

namespace simbench::app {
namespace {

using evaluation::Budget;
using evaluation::Results;
using evaluation::Row;
using scenarios::Pipeline;
using scenarios::Scenario;

constexpr std::uint64_t kMostBudgetSeeds = 4;
constexpr double kMostBudgetEvents = 20e6;

// Returns as many seeds as are cheap, going by the events of a mean run.
std::uint64_t affordable_seeds(const Results& results, const Pipeline& pipeline) {
  const std::uint64_t runs = results.rows.size() * results.seed_count;
  if (runs == 0 || results.performance.events == 0) return 0;
  const double of_seed = static_cast<double>(results.performance.events) /
                         static_cast<double>(runs) *
                         static_cast<double>(evaluation::stage_sets({pipeline}));
  const auto affordable = static_cast<std::uint64_t>(kMostBudgetEvents / of_seed);
  return std::min({kMostBudgetSeeds, affordable, results.seed_count});
}

std::optional<Budget> affordable_budget(const Results& results, const Scenario& scenario,
                                        const Row& row, const evaluation::Progress& progress) {
  const auto pipeline = std::ranges::find(scenario.pipelines, row.pipeline, &Pipeline::name);
  if (pipeline == scenario.pipelines.end() || pipeline->programs.has_value()) return std::nullopt;
  const std::uint64_t seeds = affordable_seeds(results, *pipeline);
  if (seeds == 0) return std::nullopt;
  return evaluation::error_budgets(scenario, {*pipeline}, simulated_world,
                                   {.first_seed = results.first_seed, .seeds = seeds}, progress)
      .front();
}

}  // namespace

void rank_by(const std::string& metric, Results& results) {
  if (metric.empty()) return;
  const auto has_value = [&results](const std::string& id) {
    return std::ranges::any_of(results.rows, [&id](const Row& row) {
      return !std::isnan(evaluation::metric(id).series(row).median);
    });
  };
  if (!has_value(metric)) {
    std::vector<std::string> known = evaluation::ranking_metrics();
    std::erase_if(known, [&](const std::string& id) { return !has_value(id); });
    throw scenarios::InputError(
        fmt::format("--rank-by: found '{}', of which these results have no value, allowed: {}",
                    metric, fmt::join(known, ", ")));
  }
  results.ranked_by = evaluation::ranked_by_named(metric).value();
}

reports::AnswerText run_answer(const Results& results, const Scenario& scenario,
                               const evaluation::Progress& progress) {
  const Row* const best = evaluation::best_of(results);
  std::optional<Budget> budget;
  if (best != nullptr) budget = affordable_budget(results, scenario, *best, progress);
  return reports::results_answer(results, budget ? &*budget : nullptr);
}

}  // namespace simbench::app
