// Tasks that are texts, so that they can be worked on anywhere: by threads of this process
// (ThreadFarm) or by the ranks of a cluster (cli/mpi/main.cc).
//
// A task and its answer are texts: a farm need not know what they are about and can carry them to
// other processes. A worker is made once for each thread, from `setup`, which all tasks share.
// Order, errors and threads are those of evaluation/run/jobs.h, of which a farm is a thin adapter.
//
//   ThreadFarm farm([](const std::string& setup) {
//     return [setup](const std::string& task) { return answer_in(setup, task); };
//   });
//   farm.run({.setup = text, .count = 1000, .task = task_text, .threads = 0},
//            [&](std::size_t task, const std::string& answer) { keep(task, answer); });
#ifndef SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_
#define SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "evaluation/run/jobs.h"

namespace simbench::evaluation {

using TaskWorker = std::function<std::string(const std::string& task)>;
// Called from the thread that will work.
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
  // Has every task worked on once. If a worker or `keep` throws, no more are begun, those that run
  // come to their end, and the exception of the first task passes through.
  virtual void run(const Tasks& tasks, const AnswerKeeper& keep) = 0;
};

// All cores of this machine.
class ThreadFarm final : public TaskFarm {
 public:
  explicit ThreadFarm(TaskWorkerFactory make_worker) : make_worker_(std::move(make_worker)) {}
  void run(const Tasks& tasks, const AnswerKeeper& keep) override;

 private:
  TaskWorkerFactory make_worker_;
};

// For those who write a farm: `keep`, whose calls from several threads wait for each other, and
// workers of this process that work on the tasks and keep the answers. Arguments must outlive them.
AnswerKeeper one_at_a_time(const AnswerKeeper& keep);
WorkerFactory task_workers(const Tasks& tasks, const TaskWorkerFactory& make_worker,
                           const AnswerKeeper& keep);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_
