// Many independent jobs, numbered from 0, on the threads of this process.
//
// Used by evaluate() for pipelines and seeds, by a sweep for points, by a reconstruction for sets.
// A farm over several processes (evaluation/sweep/task_farm.h, cli/mpi/main.cc) takes its jobs from
// the same queue.
//
// Contract
//  - Order: jobs begin in the order of their numbers and end in any. Each runs once. A job writes
//    its result to a place of its own, so that results do not depend on the number of threads.
//  - Threads: at most one per job; the calling thread is one of them. One thread runs the jobs in
//    order. If the system cannot start a further thread, the existing ones do the work.
//  - Workers: a worker is made once on each thread, used by it alone, and destroyed there.
//  - Errors: if a job throws, no further job begins, running jobs finish, and the exception of the
//    job with the lowest number is thrown: the same one with any number of threads, since every job
//    before it had begun. A worker that cannot be made counts as an error before all jobs.
//  - Cancelling: once `cancel` is true, no further job begins. A signal handler may set it.
//
//   std::vector<double> squares(100);
//   bool all = run_jobs(squares.size(), {.threads = 0, .cancel = &interrupted},
//                       [&](std::size_t job) { squares[job] = double(job) * double(job); });
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

namespace simbench::evaluation {

struct JobOptions {
  unsigned threads = 0;                       // 0: as many as there are cores
  const std::atomic<bool>* cancel = nullptr;  // polled before each job
};

using Job = std::function<void(std::size_t job)>;
// Makes the worker of one thread; called on that thread.
using WorkerFactory = std::function<Job()>;

// How many threads that is: `threads`, or one for every core if it is 0.
std::size_t worker_count(unsigned threads);

// Both return whether all jobs ran: false only if they were cancelled.
bool run_jobs(std::size_t count, const JobOptions& options, const Job& job);
bool run_jobs_with_workers(std::size_t count, const JobOptions& options,
                           const WorkerFactory& make_worker);

// What a job has thrown, with scenario, pipeline, seed, version and commit.
class JobFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct JobName {
  std::string scenario;
  std::string pipeline;
  std::uint64_t seed = 0;
};

// Runs a job whose errors name it. Throws scenarios::InputError for a world that its backend
// refuses, with the job's name; RecordingCancelled as it is; JobFailed for any other exception of
// `action`.
void run_named(const JobName& name, const std::function<void()>& action);

// The CPU time that threads have taken, added up.
class CpuTime {
 public:
  double seconds() const;

 private:
  friend class CpuTimer;
  mutable std::mutex mutex_;
  double seconds_ = 0;
};

// Adds what its thread takes during its lifetime.
class CpuTimer {
 public:
  // `total` must outlive this.
  explicit CpuTimer(CpuTime& total);
  ~CpuTimer();
  CpuTimer(const CpuTimer&) = delete;
  CpuTimer& operator=(const CpuTimer&) = delete;

 private:
  CpuTime& total_;
  double begin_;
};

// One thread's backend, whose CPU time ends when it is gone.
template <class Source>
struct TimedWorker {
  TimedWorker(CpuTime& total, const std::function<std::unique_ptr<Source>()>& make_source)
      : timer(total), source(make_source()) {}

  CpuTimer timer;
  std::unique_ptr<Source> source;
};

// The remaining jobs, for callers that give some of them to other processes. Thread-safe.
class JobQueue {
 public:
  explicit JobQueue(std::size_t count, const std::atomic<bool>* cancel = nullptr)
      : count_(count), cancel_(cancel) {}
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  // Returns the next job; nothing once all have begun, one has failed or they are cancelled.
  std::optional<std::size_t> next();
  // The number of jobs that next() has not returned yet.
  std::size_t left() const;
  // Runs a job from next(); an exception of `action` is the job's error.
  void attempt(std::size_t job, const std::function<void()>& action);
  // Makes a worker, which attempts jobs until none is left.
  void work(const WorkerFactory& make_worker);
  // After all attempts: throws the first job's error, else returns whether all jobs ran.
  bool finish() const;

 private:
  bool stopped() const;
  // `rank` orders errors: that of a job is its number + 1.
  void fail(std::size_t rank, std::exception_ptr error);

  const std::size_t count_;
  const std::atomic<bool>* const cancel_;
  mutable std::mutex mutex_;  // guards what follows
  std::size_t next_ = 0;
  std::size_t done_ = 0;
  std::exception_ptr error_;
  std::size_t error_rank_ = 0;
};

}  // namespace simbench::evaluation
