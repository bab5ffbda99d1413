#include "evaluation/sweep/task_farm.h"

#include <memory>
#include <mutex>

namespace simbench::evaluation {

AnswerKeeper one_at_a_time(const AnswerKeeper& keep) {
  return
      [&keep, mutex = std::make_shared<std::mutex>()](std::size_t task, const std::string& answer) {
        const std::lock_guard lock(*mutex);
        keep(task, answer);
      };
}

WorkerFactory task_workers(const Tasks& tasks, const TaskWorkerFactory& make_worker,
                           const AnswerKeeper& keep) {
  return [&]() -> Job {
    return [&tasks, &keep, worker = make_worker(tasks.setup)](std::size_t task) {
      keep(task, worker(tasks.task(task)));
    };
  };
}

void ThreadFarm::run(const Tasks& tasks, const AnswerKeeper& keep) {
  const AnswerKeeper keep_safely = one_at_a_time(keep);
  run_jobs_with_workers(tasks.count, {.threads = tasks.threads},
                        task_workers(tasks, make_worker_, keep_safely));
}

}  // namespace simbench::evaluation
