#include "evaluation/budget/pipeline_budget.h"

#include <cstdint>
#include <utility>

namespace simbench::evaluation {

std::vector<PipelineBudget> pipeline_budgets(const scenarios::Scenario& scenario,
                                             const std::vector<scenarios::Pipeline>& pipelines,
                                             const WorldFactory& make_world,
                                             const EvaluationOptions& options,
                                             const Progress& progress) {
  // The host clocks first: only they know how many of the pipelines they run.
  std::uint64_t host_clock_runs = 0;
  const std::uint64_t stage_runs =
      stage_sets(scenario, pipelines) * pipelines.size() * options.seeds;
  std::vector<HostClockBudget> host_clocks = host_clock_budgets(
      scenario, pipelines, make_world, options, [&](std::uint64_t done, std::uint64_t total) {
        host_clock_runs = total;
        if (progress) progress(done, total + stage_runs);
      });
  std::vector<Budget> stages = error_budgets(
      scenario, pipelines, make_world, options, [&](std::uint64_t done, std::uint64_t total) {
        if (!progress) return;
        progress(host_clock_runs + done, host_clock_runs + total);
      });
  std::vector<PipelineBudget> budgets;
  budgets.reserve(stages.size());
  for (std::size_t i = 0; i < stages.size(); ++i) {
    budgets.push_back({std::move(stages[i]), std::move(host_clocks[i])});
  }
  return budgets;
}

}  // namespace simbench::evaluation
