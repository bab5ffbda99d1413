// Many independent pieces of work, given to whoever is free: threads of this process (ThreadFarm),
// or ranks of a cluster (cli/mpi/main.cc).
//
// A task and its answer are texts, so that a farm need not know what they are about and can carry
// them anywhere. A worker is made once for each thread, from `setup`, which all tasks share.
//
//   ThreadFarm farm([](const std::string& setup) {
//     return [world = World(setup)](const std::string& task) { return world.answer(task); };
//   });
//   farm.run({.setup = scenario, .count = 1000, .task = task_text, .threads = 0},
//            [&](std::size_t task, const std::string& answer) { log.append(task, answer); });
#ifndef SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_
#define SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_

#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace simbench::evaluation {

using TaskWorker = std::function<std::string(const std::string& task)>;
// Called from the thread that will work.
using TaskWorkerFactory = std::function<TaskWorker(const std::string& setup)>;
// Takes an answer; from any thread of the process that called run(), one call at a time.
using AnswerKeeper = std::function<void(std::size_t task, const std::string& answer)>;

struct Tasks {
  std::string setup;
  std::size_t count = 0;
  std::function<std::string(std::size_t)> task;  // its text; called one at a time, in order
  unsigned threads = 0;                          // of each process; 0: the farm's own choice
};

class TaskFarm {
 public:
  virtual ~TaskFarm() = default;
  // Has every task worked on once, begun in order and answered in any. If a worker or `keep`
  // throws, no more are begun, those that run come to their end, and the first exception passes
  // through.
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

// What is left of the tasks, for those who write a farm. Safe to be called by several threads.
class TaskQueue {
 public:
  struct Task {
    std::size_t index = 0;
    std::string text;
  };

  TaskQueue(const Tasks& tasks, const AnswerKeeper& keep) : tasks_(tasks), keep_(keep) {}

  // Nothing once all are given out or one has failed.
  std::optional<Task> next();
  // How many next() has still to give.
  std::size_t left() const;
  void answered(std::size_t task, const std::string& answer);
  void failed(std::exception_ptr error);
  // Makes a worker and lets it work until there is nothing left; what it throws goes to failed().
  void work_off(const TaskWorkerFactory& make_worker);
  // Throws the first failure, if there was one.
  void rethrow_failure() const;

 private:
  const Tasks& tasks_;
  const AnswerKeeper& keep_;
  mutable std::mutex mutex_;  // guards what follows, and calls
  std::size_t next_ = 0;
  std::exception_ptr failure_;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_SWEEP_TASK_FARM_H_
