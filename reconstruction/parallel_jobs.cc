#include "reconstruction/parallel_jobs.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace simbench::reconstruction {
namespace {

class JobQueue {
 public:
  JobQueue(std::size_t count, const std::atomic<bool>* cancel,
           const std::function<void(std::size_t)>& job)
      : count_(count), cancel_(cancel), job_(job) {}

  void work() {
    for (std::size_t job = next(); job < count_; job = next()) {
      try {
        job_(job);
        ++done_;
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_ || job < failed_job_) {
          failure_ = std::current_exception();
          failed_job_ = job;
        }
      }
    }
  }

  bool finish() const {
    if (failure_) std::rethrow_exception(failure_);
    return done_ == count_;
  }

 private:
  std::size_t next() {
    const std::lock_guard lock(mutex_);
    const bool stop = failure_ || (cancel_ != nullptr && cancel_->load());
    return stop ? count_ : std::min(next_++, count_);
  }

  std::size_t count_;
  const std::atomic<bool>* cancel_;
  const std::function<void(std::size_t)>& job_;
  std::mutex mutex_;  // guards what follows
  std::size_t next_ = 0;
  std::exception_ptr failure_;
  std::size_t failed_job_ = 0;
  std::atomic<std::size_t> done_ = 0;
};

}  // namespace

bool run_jobs(std::size_t count, unsigned threads, const std::atomic<bool>* cancel,
              const std::function<void(std::size_t)>& job) {
  JobQueue queue(count, cancel, job);
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t workers = std::min<std::size_t>(threads, count);
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < workers; ++i) others.emplace_back([&queue] { queue.work(); });
    queue.work();
  }
  return queue.finish();
}

}  // namespace simbench::reconstruction
