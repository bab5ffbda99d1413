// The runs of a sweep as tasks, worked on by threads of this process (ThreadFarm) or by the ranks
// of a cluster (cli/mpi/main.cc).
//
// Tasks and answers are texts: a farm does not interpret them and can send them to other processes.
// A worker is made once for each thread, from `setup`, which all tasks share. Order, errors and
// threads are those of evaluation/run/jobs.h, of which a farm is a thin adapter.
//
// A task has the runs that share captures, or at least the cameras' half of their world, so that
// this is made once (evaluation/run/capture_groups.h). Which runs go together changes no result.
//
//   ThreadFarm farm(sweep_workers(make_world, make_clocks));
//   const SweepTasks tasks(plan, missing);
//   farm.run(tasks.tasks(), [&](std::size_t task, const std::string& answer) {
//     tasks.each_run(task, answer, [&](std::size_t run, const std::string& text) {
//       scores[run] = score_of(text, plan.kind);              // evaluation/sweep/sweep_score.h
//     });
//   });
#pragma once

#include <cstddef>
#include <functional>
#include <span>
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

// Some runs of a plan as tasks. A task has the pipelines of one point and seed, and those of other
// points that differ from it in scoring alone; once it has kSharedRuns of them, it takes no further
// point. Runs of clocks alone share nothing, and are a task each.
class SweepTasks {
 public:
  static constexpr std::size_t kSharedRuns = 16;

  // `plan` must outlive this.
  SweepTasks(const SweepPlan& plan, std::vector<std::size_t> runs);
  SweepTasks(const SweepTasks&) = delete;
  SweepTasks& operator=(const SweepTasks&) = delete;

  // This must outlive them.
  Tasks tasks() const;
  // The runs of a task, by their numbers in the plan, in the order in which it answers.
  std::span<const std::size_t> runs(std::size_t task) const;
  // Calls `keep` with each run of the task and its text.
  void each_run(std::size_t task, const std::string& answer,
                const std::function<void(std::size_t run, const std::string& text)>& keep) const;

 private:
  const SweepPlan& plan_;
  std::vector<std::size_t> runs_;    // task by task
  std::vector<std::size_t> begins_;  // of each task in runs_, and the end of the last
};

// A worker keeps what it made of the points of its last task, which the next one mostly shares. It
// throws what evaluate() and evaluate_clocks() throw, with the run that failed first.
TaskWorkerFactory sweep_workers(WorldFactory make_world, ClockWorldFactory make_clocks);

}  // namespace simbench::evaluation
