#include "evaluation/sweep/task_farm.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

TaskWorkerFactory echo() {
  return [](const std::string& setup) {
    return [setup](const std::string& task) { return setup + task; };
  };
}

Tasks tasks(std::size_t count, unsigned threads) {
  return {.setup = "s",
          .count = count,
          .task = [](std::size_t i) { return std::to_string(i); },
          .threads = threads};
}

TEST(ThreadFarm, EveryTaskOnceWithAnyNumberOfThreads) {
  for (const unsigned threads : {0U, 1U, 3U, 100U}) {
    std::vector<std::string> answers(50);
    ThreadFarm(echo()).run(tasks(50, threads), [&](std::size_t task, const std::string& answer) {
      EXPECT_TRUE(answers[task].empty());
      answers[task] = answer;
    });
    for (std::size_t i = 0; i < nonempty(answers).size(); ++i) {
      EXPECT_EQ(answers[i], fmt::format("s{}", i));
    }
  }
}

TEST(ThreadFarm, NoTasks) {
  ThreadFarm(echo()).run(tasks(0, 4), [](std::size_t, const std::string&) { FAIL(); });
}

TEST(ThreadFarm, AFailureStopsThoseNotBegun) {
  std::atomic<int> worked = 0;
  const auto make = [&](const std::string&) -> TaskWorker {
    return [&](const std::string& task) -> std::string {
      ++worked;
      if (task == "5") throw std::runtime_error("task 5");
      return task;
    };
  };
  try {
    ThreadFarm(make).run(tasks(1000, 1), [](std::size_t, const std::string&) {});
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "task 5");
  }
  EXPECT_EQ(worked, 6);
}

TEST(ThreadFarm, WhatTheKeeperThrowsPassesThrough) {
  int kept = 0;
  const auto keep = [&](std::size_t, const std::string&) {
    if (++kept == 3) throw std::runtime_error("disk full");
  };
  EXPECT_THROW(ThreadFarm(echo()).run(tasks(100, 1), keep), std::runtime_error);
  EXPECT_EQ(kept, 3);
}

TEST(ThreadFarm, AWorkerThatCannotBeMade) {
  const auto make = [](const std::string&) -> TaskWorker { throw std::runtime_error("no world"); };
  EXPECT_THROW(ThreadFarm(make).run(tasks(4, 2), [](std::size_t, const std::string&) { FAIL(); }),
               std::runtime_error);
}

}  // namespace
}  // namespace simbench::evaluation
