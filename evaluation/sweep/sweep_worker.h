// What works on a sweep, one run at a time: the tasks, the workers and their answers as texts, so
// that it does not matter where they work (evaluation/sweep/task_farm.h).
//
//   ThreadFarm farm(sweep_workers(make_world));
//   farm.run(sweep_tasks(plan, missing), [&](std::size_t task, const std::string& answer) {
//     scores[missing[task]] = score_of(answer);               // evaluation/sweep/sweep_score.h
//   });
#ifndef SIMBENCH_EVALUATION_SWEEP_SWEEP_WORKER_H_
#define SIMBENCH_EVALUATION_SWEEP_SWEEP_WORKER_H_

#include <cstddef>
#include <vector>

#include "evaluation/budget/budget.h"
#include "evaluation/sweep/sweep_plan.h"
#include "evaluation/sweep/task_farm.h"

namespace simbench::evaluation {

// One task for each of these runs of the plan, in this order. Both must outlive the tasks.
Tasks sweep_tasks(const SweepPlan& plan, const std::vector<std::size_t>& runs);

// A worker keeps the scenario of its last task: neighbours share it. It throws what evaluate()
// throws; make_world is called from the worker's thread.
TaskWorkerFactory sweep_workers(WorldFactory make_world);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_SWEEP_WORKER_H_
