#include "evaluation/sweep/task_farm.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "evaluation/sweep/sweep_score.h"
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
  const TaskWorkerFactory make = sweep_workers(
      [](const scenarios::Scenario&) { return std::make_unique<TooLargeWorld>(); }, nullptr);
  const scenarios::Scenario world = scenarios::load_scenario("3cam_1host_30fps");
  const TaskWorker worker =
      make(nlohmann::json{{"name", world.name}, {"scenario", world.resolved_json()}}.dump());
  const std::string task = R"({"pipeline":"oracle","seed":7,"values":[["/timeline/frames","30"]]})";
  EXPECT_THAT([&] { worker(task); },
              testing::ThrowsMessage<scenarios::InputError>(testing::AllOf(
                  testing::HasSubstr("/timeline/frames"),
                  testing::HasSubstr("pipeline oracle, seed 7: found a world that is too large"))));
}

// Slaves that are as many milliseconds late as the seed says; the first reading is far off.
class LateClocks final : public ClockSource {
 public:
  explicit LateClocks(int hosts) : errors_s_(static_cast<std::size_t>(hosts), 0.0) {}
  ClockCost run(const ClockRequest& request, ClockSink& sink) override {
    const Nanoseconds end = request.duration + request.master_lost_for + request.recovery;
    for (Nanoseconds at{}; at <= end; at += request.interval) {
      errors_s_.back() = -1e-3 * static_cast<double>(at == Nanoseconds{} ? 500 : request.seed);
      sink.on_errors(TrueTime{} + at, errors_s_);
    }
    return {.messages = 40};
  }

 private:
  std::vector<double> errors_s_;
};

TEST(SweepWorkers, ClockRunsHaveTheirPeriodFromThePlan) {
  const SweepPlan plan = make_plan({.scenario = "6host_star",
                                    .axes = {"/network/latency_exponential_ms=0,1"},
                                    .pipelines = {"chrony"},
                                    .first_seed = 3,
                                    .seeds = 2,
                                    .kind = ResultKind::kClockRuns,
                                    .clock_period = {.from_s = 10, .duration_s = 20}});
  const TaskWorkerFactory make = sweep_workers(
      [](const scenarios::Scenario&) { return std::make_unique<TooLargeWorld>(); },
      [](const scenarios::Scenario& of) { return std::make_unique<LateClocks>(of.hosts.count); });
  const std::vector<std::size_t> runs = {0, 1, 2, 3};
  std::vector<SweepScore> scores(4);
  ThreadFarm(make).run(sweep_tasks(plan, runs), [&](std::size_t task, const std::string& answer) {
    const auto score = score_of(answer, plan.kind);
    ASSERT_TRUE(score) << answer;
    EXPECT_FALSE(score_of(answer)) << "of captures: " << answer;
    scores[task] = *score;
  });
  for (std::size_t run = 0; run < 4; ++run) {
    const double late_ms = run % 2 == 0 ? 3 : 4;
    EXPECT_NEAR(scores[run].at("max_te_ms"), late_ms, 1e-12);
    EXPECT_NEAR(scores[run].at("clock_spread_ms"), late_ms, 1e-12);
    EXPECT_NEAR(scores[run].at("dynamic_te_ms"), 0, 1e-12) << "the first reading is before from_s";
    EXPECT_EQ(scores[run].at("packets_per_s"), 2);
    ASSERT_EQ(scores[run].host_errors_ms.size(), 6U);
    EXPECT_EQ(scores[run].host_errors_ms[0], 0);
    EXPECT_NEAR(scores[run].host_errors_ms[5], -late_ms, 1e-12);
  }
  const std::vector<ResponseRow> rows = response(plan, scores);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[1].value(metric("max_te_ms", plan.kind)), 3.5, 1e-12);
  EXPECT_NEAR(rows[1].hosts[5].median, 3.5, 1e-12);
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
