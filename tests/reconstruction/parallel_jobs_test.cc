#include "reconstruction/parallel_jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace simbench::reconstruction {
namespace {

TEST(RunJobs, DoesEachJobOnce) {
  for (const unsigned threads : {0U, 1U, 2U, 7U}) {
    std::vector<std::atomic<int>> done(100);
    EXPECT_TRUE(run_jobs(done.size(), threads, nullptr, [&](std::size_t job) { ++done[job]; }));
    for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
  }
}

TEST(RunJobs, OfNoJobsIsDone) {
  EXPECT_TRUE(run_jobs(0, 2, nullptr, [](std::size_t) { FAIL(); }));
}

TEST(RunJobs, BeginsNoMoreOnceCancelled) {
  std::atomic<bool> cancel = false;
  int begun = 0;
  EXPECT_FALSE(run_jobs(10, 1, &cancel, [&](std::size_t job) {
    ++begun;
    if (job == 3) cancel = true;
  }));
  EXPECT_EQ(begun, 4);
}

TEST(RunJobs, ThrowsWhatTheFirstJobThrewAndBeginsNoMore) {
  int begun = 0;
  try {
    run_jobs(10, 1, nullptr, [&](std::size_t job) {
      ++begun;
      if (job >= 2) throw std::runtime_error(std::to_string(job));
    });
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "2");
  }
  EXPECT_EQ(begun, 3);
}

}  // namespace
}  // namespace simbench::reconstruction
