#include "evaluation/run/jobs.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "recording/recording.h"
#include "recording/version.h"
#include "scenarios/loader.h"

namespace simbench::evaluation {

namespace {

double thread_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

}  // namespace

void run_named(const JobName& name, const std::function<void()>& action) {
  const auto text = [&name] {
    return fmt::format("{}, pipeline {}, seed {}", name.scenario, name.pipeline, name.seed);
  };
  try {
    action();
  } catch (const RecordingCancelled&) {
    throw;
  } catch (const scenarios::InputError& error) {
    // With the cause inside, for users who want more than its text.
    std::throw_with_nested(scenarios::InputError(fmt::format("{}: {}", text(), error.what())));
  } catch (const std::exception& error) {
    throw JobFailed(
        fmt::format("{}: {} (simbench {}, commit {})", text(), error.what(), version(), commit()));
  }
}

double CpuTime::seconds() const {
  const std::lock_guard lock(mutex_);
  return seconds_;
}

CpuTimer::CpuTimer(CpuTime& total) : total_(total), begin_(thread_cpu_seconds()) {}

CpuTimer::~CpuTimer() {
  const std::lock_guard lock(total_.mutex_);
  total_.seconds_ += thread_cpu_seconds() - begin_;
}

bool JobQueue::stopped() const {
  return error_ != nullptr || (cancel_ != nullptr && cancel_->load());
}

std::optional<std::size_t> JobQueue::next() {
  const std::lock_guard lock(mutex_);
  if (next_ == count_ || stopped()) return std::nullopt;
  return next_++;
}

std::size_t JobQueue::left() const {
  const std::lock_guard lock(mutex_);
  return stopped() ? 0 : count_ - next_;
}

void JobQueue::fail(std::size_t rank, std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  if (error_ != nullptr && error_rank_ <= rank) return;
  error_ = std::move(error);
  error_rank_ = rank;
}

void JobQueue::attempt(std::size_t job, const std::function<void()>& action) {
  try {
    action();
    const std::lock_guard lock(mutex_);
    ++done_;
  } catch (...) {
    fail(job + 1, std::current_exception());
  }
}

void JobQueue::work(const WorkerFactory& make_worker) {
  try {
    const Job worker = make_worker();
    while (const std::optional<std::size_t> job = next()) attempt(*job, [&] { worker(*job); });
  } catch (...) {
    fail(0, std::current_exception());
  }
}

bool JobQueue::finish() const {
  const std::lock_guard lock(mutex_);
  if (error_ != nullptr) std::rethrow_exception(error_);
  return done_ == count_;
}

std::size_t worker_count(unsigned threads) {
  return threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

bool run_jobs_with_workers(std::size_t count, const JobOptions& options,
                           const WorkerFactory& make_worker) {
  const std::size_t wanted = worker_count(options.threads);
  JobQueue queue(count, options.cancel);
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t i = 1; i < std::min(wanted, count); ++i) {
        others.emplace_back([&] { queue.work(make_worker); });
      }
    } catch (const std::system_error&) {
      // The existing threads do the work.
    }
    queue.work(make_worker);
  }
  return queue.finish();
}

bool run_jobs(std::size_t count, const JobOptions& options, const Job& job) {
  return run_jobs_with_workers(count, options, [&] { return job; });
}

}  // namespace simbench::evaluation
