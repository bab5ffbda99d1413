// All that is known of what causes a pipeline's errors: the budget of its stages and that of its
// host clocks.
//
// Cost and errors: as of error_budgets() and host_clock_budgets(). Progress counts the runs of
// both.
//
//   for (const PipelineBudget& budget :
//        pipeline_budgets(scenario, scenario.pipelines, make_world, {.seeds = 32}, nullptr)) {
//     print(budget.host_clock.algorithm.mean);
//   }
#pragma once

#include <cstddef>
#include <vector>

#include "evaluation/budget/budget.h"
#include "evaluation/budget/host_clock_budget.h"

namespace simbench::evaluation {

struct PipelineBudget {
  Budget stages;
  HostClockBudget host_clock;
};

// Runs of each seed, of a pipeline whose host clocks are divided, without polls and whose exposures
// nobody steers.
inline constexpr std::size_t kBudgetRuns = (std::size_t{1} << kCommonStages) + kHostClockWorlds;

// Returns one for each pipeline, in this order.
std::vector<PipelineBudget> pipeline_budgets(const scenarios::Scenario& scenario,
                                             const std::vector<scenarios::Pipeline>& pipelines,
                                             const WorldFactory& make_world,
                                             const EvaluationOptions& options,
                                             const Progress& progress);

}  // namespace simbench::evaluation
