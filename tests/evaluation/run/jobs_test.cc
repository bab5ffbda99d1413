#include "evaluation/run/jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace simbench::evaluation {
namespace {

TEST(RunJobs, DoesEachJobOnceWithAnyNumberOfThreads) {
  for (const unsigned threads : {0U, 1U, 2U, 7U, 200U}) {
    std::vector<std::atomic<int>> done(100);
    EXPECT_TRUE(run_jobs(done.size(), {.threads = threads}, [&](std::size_t job) { ++done[job]; }));
    for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
  }
}

TEST(RunJobs, NoJobsAreDoneAtOnce) {
  EXPECT_TRUE(run_jobs(0, {.threads = 2}, [](std::size_t) { FAIL(); }));
}

TEST(RunJobs, OneThreadIsTheCallersAndGoesInOrder) {
  std::vector<std::size_t> order;
  run_jobs(5, {.threads = 1}, [&, caller = std::this_thread::get_id()](std::size_t job) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    order.push_back(job);
  });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

// Two jobs that wait for each other end only if they run at the same time.
TEST(RunJobs, JobsRunAtTheSameTime) {
  std::mutex mutex;
  std::condition_variable changed;
  int arrived = 0;
  EXPECT_TRUE(run_jobs(2, {.threads = 2}, [&](std::size_t) {
    std::unique_lock lock(mutex);
    ++arrived;
    changed.notify_all();
    changed.wait(lock, [&] { return arrived == 2; });
  }));
}

TEST(RunJobs, BeginsNoMoreOnceCancelled) {
  std::atomic<bool> cancel = false;
  int begun = 0;
  EXPECT_FALSE(run_jobs(10, {.threads = 1, .cancel = &cancel}, [&](std::size_t job) {
    ++begun;
    if (job == 3) cancel = true;
  }));
  EXPECT_EQ(begun, 4);
}

TEST(RunJobs, CancelledWithTheLastJobAllAreDone) {
  std::atomic<bool> cancel = false;
  EXPECT_TRUE(
      run_jobs(4, {.threads = 1, .cancel = &cancel}, [&](std::size_t job) { cancel = job == 3; }));
}

TEST(RunJobs, CancelledBeforehandNothingBegins) {
  const std::atomic<bool> cancel = true;
  EXPECT_FALSE(run_jobs(3, {.threads = 2, .cancel = &cancel}, [](std::size_t) { FAIL(); }));
}

TEST(RunJobs, BeginsNoMoreAfterAnError) {
  int begun = 0;
  EXPECT_THROW(run_jobs(10, {.threads = 1},
                        [&](std::size_t job) {
                          ++begun;
                          if (job >= 2) throw std::runtime_error("no");
                        }),
               std::runtime_error);
  EXPECT_EQ(begun, 3);
}

// Whichever thread is faster: every job from 3 on throws, and 3 has always begun.
TEST(RunJobs, TheErrorIsThatOfTheFirstJobWithAnyNumberOfThreads) {
  for (const unsigned threads : {1U, 2U, 8U}) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      try {
        run_jobs(50, {.threads = threads}, [](std::size_t job) {
          if (job == 3) std::this_thread::yield();
          if (job >= 3) throw std::runtime_error(std::to_string(job));
        });
        FAIL() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "3");
      }
    }
  }
}

TEST(RunJobsWithWorkers, AWorkerLivesOnOneThread) {
  struct Worker {
    std::thread::id thread = std::this_thread::get_id();
    std::atomic<int>& gone;
    explicit Worker(std::atomic<int>& count) : gone(count) {}
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;
    ~Worker() {
      EXPECT_EQ(std::this_thread::get_id(), thread);
      ++gone;
    }
  };
  std::atomic<int> made = 0;
  std::atomic<int> gone = 0;
  EXPECT_TRUE(run_jobs_with_workers(100, {.threads = 3}, [&]() -> Job {
    ++made;
    return [worker = std::make_shared<Worker>(gone)](std::size_t) {
      EXPECT_EQ(std::this_thread::get_id(), worker->thread);
    };
  }));
  EXPECT_EQ(made, 3);
  EXPECT_EQ(gone, 3);
}

TEST(RunJobsWithWorkers, AWorkerThatCannotBeMadeIsTheFirstError) {
  const WorkerFactory make = []() -> Job { throw std::runtime_error("no world"); };
  for (const unsigned threads : {1U, 4U}) {
    try {
      run_jobs_with_workers(8, {.threads = threads}, make);
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "no world");
    }
  }
}

TEST(JobQueue, OthersMayTakeJobsAndBringTheirResults) {
  JobQueue queue(3);
  EXPECT_EQ(queue.next(), 0U);
  EXPECT_EQ(queue.left(), 2U);
  queue.work([] { return [](std::size_t) {}; });
  EXPECT_EQ(queue.left(), 0U);
  EXPECT_FALSE(queue.finish());
  queue.attempt(0, [] {});
  EXPECT_TRUE(queue.finish());
}

TEST(JobQueue, AnErrorBroughtLateCountsByTheNumberOfItsJob) {
  JobQueue queue(3);
  for (std::size_t job = 0; job < 3; ++job) EXPECT_EQ(queue.next(), job);
  queue.attempt(2, [] { throw std::runtime_error("two"); });
  queue.attempt(1, [] { throw std::runtime_error("one"); });
  EXPECT_EQ(queue.left(), 0U);
  try {
    queue.finish();
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "one");
  }
}

}  // namespace
}  // namespace simbench::evaluation
