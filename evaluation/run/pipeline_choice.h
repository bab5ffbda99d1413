// The pipelines of a scenario with the registered algorithms that their names stand for.
//
// An algorithm's parameters are looked up in the scenario under /algorithms/<its family> and,
// before that, /algorithms/<its name>; several algorithms may share a family and each takes what it
// declares. A parameter that no algorithm of that name declares is refused, and so is an algorithm
// that needs what the scenario's world does not have (AlgorithmInfo::needs). A device_time may be
// named with the suffixes of its variants (algorithms/device_time/variants.h).
//
//   for (const PipelineChoice& choice : choose_pipelines(scenario, {"yoon2021_both"})) {
//     PipelineScorer scorer(scorer_setup(scenario, choice));
//   }
#ifndef SIMBENCH_EVALUATION_RUN_PIPELINE_CHOICE_H_
#define SIMBENCH_EVALUATION_RUN_PIPELINE_CHOICE_H_

#include <string>
#include <vector>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "scenarios/scenario.h"

namespace simbench::evaluation {

struct PipelineChoice {
  scenarios::Pipeline pipeline;
  HostSyncEntry host_sync;
  Parameters host_sync_parameters;
  DeviceTimeEntry device_time;          // of the base name
  DeviceTimeName device_time_variants;  // what the pipeline's name adds to it
  Parameters device_time_parameters;
  GatheringEntry gathering;
  Parameters gathering_parameters;
};

// The named pipelines in the given order; all of the scenario if `names` is empty. Throws
// scenarios::InputError for a pipeline or algorithm that is not known (naming those that are), a
// pipeline named twice, or a parameter that is not declared or not allowed.
std::vector<PipelineChoice> choose_pipelines(const scenarios::Scenario& scenario,
                                             const std::vector<std::string>& names);

// What PipelineScorer needs to score it. The second, offline estimator is asked for where claim C7
// compares with it, in captures of at most 200,000 evaluated frames: it keeps them.
ScorerSetup scorer_setup(const scenarios::Scenario& scenario, const PipelineChoice& choice);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_RUN_PIPELINE_CHOICE_H_
