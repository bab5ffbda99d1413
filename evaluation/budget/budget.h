// The error budget of a pipeline: which stage its error comes from.
//
// A stage's part is its Shapley value: what replacing the stage by its oracle takes off the error,
// averaged over all orders in which the seven stages can be replaced, and so over all 2^7 worlds
// with some of them ideal, each simulated with the same seeds. The parts and the remainder (the
// error that is left when all stages are ideal) add up to the error, for each seed exactly. A part
// may be negative: two errors can cancel.
//
// Three errors are divided:
//  - amd_ms: over the sets that gathering emits, so that gathering counts; if in some of the worlds
//    it emits none, over the true pulses, where it has no part (amd_of_sets tells which);
//  - absolute_error_ms: likewise;
//  - physical_ms: how far apart the exposures of a pulse really were (exposure_spread). The same in
//    all clocks, so no algorithm can remove it; AMD contains it.
//
// Cost: 128 runs of the pipeline per seed. Source: Shapley, "A value for n-person games", 1953.
//
//   const Budget budget = error_budget(scenario, pipeline, make_world, {.seeds = 32}, nullptr);
#ifndef SIMBENCH_EVALUATION_BUDGET_BUDGET_H_
#define SIMBENCH_EVALUATION_BUDGET_BUDGET_H_

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "evaluation/budget/ideal_world.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/scoring/results.h"

namespace simbench::evaluation {

// Means over the seeds, with the band from 5 to 95 %. Means, because they add up.
struct BudgetPart {
  std::vector<double> values;  // by seed
  double mean = 0;
  double p05 = 0;
  double p95 = 0;
};

// One error, divided.
struct ErrorParts {
  BudgetPart total;
  std::array<BudgetPart, kStageCount> stages;
  BudgetPart remainder;
};

struct Budget {
  std::string pipeline;
  bool amd_of_sets = true;
  ErrorParts amd_ms;
  ErrorParts absolute_error_ms;
  ErrorParts physical_ms;
};

// The backend for a world; called from worker threads, the scenario outlives what it returns.
using WorldFactory = std::function<std::unique_ptr<RecordingSource>(const scenarios::Scenario&)>;

// Of options, pipelines and keep_pulses are not used. Throws what evaluate() throws.
Budget error_budget(const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline,
                    const WorldFactory& make_world, const EvaluationOptions& options,
                    const Progress& progress);

// Shapley values of n players: `worth[s]` belongs to the coalition whose members are the bits of s,
// 2^n values in all; the result says by how much each player lowers it. O(n 2^n).
std::vector<double> shapley_values(std::span<const double> worth);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_BUDGET_BUDGET_H_
