// The runs of a sweep as tasks, worked on by threads of this process (ThreadFarm) or by the ranks
// of a cluster (cli/mpi/main.cc).
//
// Tasks and answers are texts: a farm does not interpret them and can send them to other processes.
// A worker is made once for each thread, from `setup`, which all tasks share. Order, errors and
// threads are those of evaluation/run/jobs.h, of which a farm is a thin adapter.
//
//   ThreadFarm farm(sweep_workers(make_world, make_clocks));
//   farm.run(sweep_tasks(plan, missing), [&](std::size_t task, const std::string& answer) {
//     scores[missing[task]] = score_of(answer, plan.kind);    // evaluation/sweep/sweep_score.h
//   });
#ifndef SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_
#define SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/clock_run/clock_evaluation.h"
#include "evaluation/run/evaluate.h"
#include "evaluation/run/jobs.h"
#include "evaluation/sweep/sweep_plan.h"

namespace simbench::evaluation {

using TaskWorker = std::function<std::string(const std::string& task)>;
// Called on the worker's thread.
using TaskWorkerFactory = std::function<TaskWorker(const std::string& setup)>;
// Takes an answer; from any thread of the process that called run(), one call at a time.
using AnswerKeeper = std::function<void(std::size_t task, const std::string& answer)>;

struct Tasks {
  std::string setup;
  std::size_t count = 0;
  std::function<std::string(std::size_t)> task;  // its text; called from any thread
  unsigned threads = 0;                          // of each process; 0: the farm's own choice
};

class TaskFarm {
 public:
  virtual ~TaskFarm() = default;
  // Works on every task once. If a worker or `keep` throws, no further task begins, running ones
  // finish, and the exception of the first task passes through.
  virtual void run(const Tasks& tasks, const AnswerKeeper& keep) = 0;
};

// Uses all cores of this machine.
class ThreadFarm final : public TaskFarm {
 public:
  explicit ThreadFarm(TaskWorkerFactory make_worker) : make_worker_(std::move(make_worker)) {}
  void run(const Tasks& tasks, const AnswerKeeper& keep) override;

 private:
  TaskWorkerFactory make_worker_;
};

// For implementations of a farm: `keep` with its calls from several threads serialised, and workers
// of this process that work on tasks and keep the answers. Arguments must outlive them.
AnswerKeeper one_at_a_time(const AnswerKeeper& keep);
WorkerFactory task_workers(const Tasks& tasks, const TaskWorkerFactory& make_worker,
                           const AnswerKeeper& keep);

// Returns one task for each of these runs of the plan, in this order. Both must outlive the tasks.
Tasks sweep_tasks(const SweepPlan& plan, const std::vector<std::size_t>& runs);

// A worker keeps the scenario of its last task, which the next one mostly shares. It throws what
// evaluate() and evaluate_clocks() throw.
TaskWorkerFactory sweep_workers(WorldFactory make_world, ClockWorldFactory make_clocks);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_
