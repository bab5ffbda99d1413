#include "evaluation/sweep/task_farm.h"

#include <algorithm>
#include <thread>
#include <vector>

namespace simbench::evaluation {

std::optional<TaskQueue::Task> TaskQueue::next() {
  const std::lock_guard lock(mutex_);
  if (failure_ || next_ == tasks_.count) return std::nullopt;
  const std::size_t index = next_++;
  return Task{index, tasks_.task(index)};
}

std::size_t TaskQueue::left() const {
  const std::lock_guard lock(mutex_);
  return failure_ ? 0 : tasks_.count - next_;
}

void TaskQueue::answered(std::size_t task, const std::string& answer) {
  const std::lock_guard lock(mutex_);
  try {
    keep_(task, answer);
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
  }
}

void TaskQueue::failed(std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(error);
}

void TaskQueue::work_off(const TaskWorkerFactory& make_worker) {
  try {
    const TaskWorker worker = make_worker(tasks_.setup);
    while (const std::optional<Task> task = next()) answered(task->index, worker(task->text));
  } catch (...) {
    failed(std::current_exception());
  }
}

void TaskQueue::rethrow_failure() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void ThreadFarm::run(const Tasks& tasks, const AnswerKeeper& keep) {
  TaskQueue queue(tasks, keep);
  const std::size_t wanted =
      tasks.threads > 0 ? tasks.threads : std::max(1U, std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < std::min(wanted, tasks.count); ++i) {
      threads.emplace_back([&] { queue.work_off(make_worker_); });
    }
    queue.work_off(make_worker_);
  }
  queue.rethrow_failure();
}

}  // namespace simbench::evaluation
