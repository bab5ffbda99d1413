#include "evaluation/sweep/task_farm.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/loader.h"
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

class TooLargeWorld final : public RecordingSource {
 public:
  RecordingCost record(const RecordingRequest& /*request*/, RecordingSink& /*sink*/) override {
    throw scenarios::InputError("found a world that is too large");
  }
};

TEST(SweepWorkers, AWorldThatIsRefusedIsBadInputWithItsPlace) {
  const TaskWorkerFactory make =
      sweep_workers([](const scenarios::Scenario&) { return std::make_unique<TooLargeWorld>(); });
  const scenarios::Scenario world = scenarios::load_scenario("3cam_1host_30fps");
  const TaskWorker worker =
      make(nlohmann::json{{"name", world.name}, {"scenario", world.resolved_json}}.dump());
  const std::string task = R"({"pipeline":"oracle","seed":7,"values":[["/timeline/frames","30"]]})";
  EXPECT_THAT([&] { worker(task); },
              testing::ThrowsMessage<scenarios::InputError>(testing::AllOf(
                  testing::HasSubstr("/timeline/frames"),
                  testing::HasSubstr("pipeline oracle, seed 7: found a world that is too large"))));
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
