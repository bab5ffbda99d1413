#include "evaluation/sweep/task_farm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/sweep/sweep_score.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

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
  const std::string task =
      R"({"runs":[{"pipeline":"oracle","values":[["/timeline/frames","30"]]}],"seed":7})";
  EXPECT_THAT([&] { worker(task); },
              testing::ThrowsMessage<scenarios::InputError>(testing::AllOf(
                  testing::HasSubstr(
                      R"({"pipeline":"oracle","seed":7,"values":[["/timeline/frames","30"]]}: )"),
                  testing::HasSubstr("pipeline oracle, seed 7: found a world that is too large"))));
}

SweepPlan interval_sweep() {
  return make_plan({.scenario = "3cam_1host_30fps",
                    .overrides = {{"/timeline/frames", "30"}},
                    .axes = {"/evaluation/gathering_interval_periods=0.1,0.5",
                             "/usb/delivery_jitter_transfers=0.1,0.4"},
                    .pipelines = {"raw_arrival", "genlock"},
                    .first_seed = 4,
                    .seeds = 2});
}

// Every run as text, "interval jitter pipeline seed", task by task.
std::vector<std::vector<std::string>> runs_of(const SweepPlan& plan, const SweepTasks& tasks) {
  std::vector<std::vector<std::string>> all;
  for (std::size_t task = 0; task < tasks.tasks().count; ++task) {
    all.emplace_back();
    for (const std::size_t number : tasks.runs(task)) {
      const SweepRun run = plan.run(number);
      all.back().push_back(fmt::format("{} {} {}", fmt::join(plan.values(run.point), " "),
                                       plan.pipelines[run.pipeline], run.seed));
    }
  }
  return all;
}

std::vector<std::size_t> all_runs(const SweepPlan& plan) {
  std::vector<std::size_t> runs(plan.runs());
  std::iota(runs.begin(), runs.end(), 0U);
  return runs;
}

TEST(SweepTasks, OneSeedOfPointsThatDifferInScoringAloneIsATask) {
  const SweepPlan plan = interval_sweep();
  const SweepTasks tasks(plan, all_runs(plan));
  EXPECT_THAT(runs_of(plan, tasks),
              ElementsAre(ElementsAre("0.1 0.1 raw_arrival 4", "0.1 0.1 genlock 4",
                                      "0.5 0.1 raw_arrival 4", "0.5 0.1 genlock 4"),
                          SizeIs(4),
                          ElementsAre("0.1 0.4 raw_arrival 4", "0.1 0.4 genlock 4",
                                      "0.5 0.4 raw_arrival 4", "0.5 0.4 genlock 4"),
                          SizeIs(4)));
}

TEST(SweepTasks, WhatIsNotMissingIsNotDone) {
  const SweepPlan plan = interval_sweep();
  const SweepTasks tasks(plan, {2, 7, 10});
  EXPECT_THAT(runs_of(plan, tasks),
              ElementsAre(ElementsAre("0.1 0.1 genlock 4", "0.5 0.1 genlock 4"),
                          ElementsAre("0.1 0.4 genlock 5")));
  EXPECT_EQ(SweepTasks(plan, {}).tasks().count, 0U);
}

TEST(SweepTasks, ALargeTaskTakesNoFurtherPoint) {
  const SweepPlan plan = make_plan({.scenario = "3cam_1host_30fps",
                                    .axes = {"/evaluation/gathering_interval_periods=1:20:1"},
                                    .pipelines = {"raw_arrival", "genlock", "oracle"},
                                    .seeds = 1});
  const SweepTasks tasks(plan, all_runs(plan));
  std::size_t runs = 0;
  for (std::size_t task = 0; task < tasks.tasks().count; ++task) {
    const std::size_t size = tasks.runs(task).size();
    EXPECT_EQ(size % 3, 0U) << "pipelines of a point go together";
    EXPECT_LT(size, SweepTasks::kSharedRuns + 3);
    runs += size;
  }
  EXPECT_EQ(runs, plan.runs());
  EXPECT_EQ(tasks.tasks().count, 4U);
}

TEST(SweepTasks, ClockRunsShareNothing) {
  const SweepPlan plan = make_plan({.scenario = "6host_star",
                                    .pipelines = {"chrony", "free_running"},
                                    .seeds = 2,
                                    .kind = ResultKind::kClockRuns,
                                    .clock_period = {.from_s = 10, .duration_s = 20}});
  EXPECT_THAT(runs_of(plan, SweepTasks(plan, all_runs(plan))),
              ElementsAre(SizeIs(1), SizeIs(1), SizeIs(1), SizeIs(1)));
}

// The simulator; counts captures, and fails with one pipeline's.
class CountedWorld final : public RecordingSource {
 public:
  CountedWorld(const scenarios::Scenario& scenario, std::size_t& captures, std::string failing)
      : world_(sim::make_simulation(scenario)), captures_(captures), failing_(std::move(failing)) {}
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    ++captures_;
    if (request.pipeline == failing_) throw std::runtime_error("no world");
    return world_->record(request, sink);
  }

 private:
  std::unique_ptr<RecordingSource> world_;
  std::size_t& captures_;
  std::string failing_;
};

struct Swept {
  std::vector<std::string> texts;
  std::size_t captures = 0;
};

// All runs of the plan, together or each as a sweep of its own.
Swept swept(const SweepPlan& plan, bool one_by_one) {
  Swept all{.texts = std::vector<std::string>(plan.runs())};
  const TaskWorkerFactory make = sweep_workers(
      [&](const scenarios::Scenario& scenario) {
        return std::make_unique<CountedWorld>(scenario, all.captures, "");
      },
      nullptr);
  std::vector<std::vector<std::size_t>> parts = {all_runs(plan)};
  if (one_by_one) {
    parts.clear();
    for (const std::size_t run : all_runs(plan)) parts.push_back({run});
  }
  for (const std::vector<std::size_t>& part : parts) {
    const SweepTasks sweep_tasks(plan, part);
    Tasks tasks = sweep_tasks.tasks();
    tasks.threads = 1;
    ThreadFarm(make).run(tasks, [&](std::size_t task, const std::string& answer) {
      sweep_tasks.each_run(task, answer, [&](std::size_t run, const std::string& text) {
        EXPECT_EQ(all.texts[run], "");
        all.texts[run] = text;
      });
    });
  }
  return all;
}

// raw_arrival and genlock leave the clocks alone, so that two points of two pipelines are a
// capture.
TEST(SweepWorkers, SharedCapturesGiveTheTextsOfEachRunAlone) {
  const SweepPlan plan = interval_sweep();
  const Swept together = swept(plan, /*one_by_one=*/false);
  const Swept alone = swept(plan, /*one_by_one=*/true);
  EXPECT_EQ(together.texts, alone.texts);
  EXPECT_EQ(alone.captures, 16U);
  EXPECT_EQ(together.captures, 4U);
  for (const std::string& text : nonempty(together.texts)) EXPECT_TRUE(score_of(text)) << text;
  EXPECT_NE(together.texts[0], together.texts[8]) << "another interval";
}

TEST(SweepWorkers, AFailureAmongOthersNamesItsRun) {
  const SweepPlan plan = make_plan({.scenario = "18cam_6host_45fps",
                                    .overrides = {{"/timeline/frames", "20"}},
                                    .axes = {"/evaluation/gathering_interval_periods=0.1,0.5"},
                                    .pipelines = {"oracle", "yoon2021_both"},
                                    .first_seed = 9,
                                    .seeds = 1});
  const SweepTasks sweep_tasks(plan, all_runs(plan));
  ASSERT_EQ(sweep_tasks.tasks().count, 1U);
  std::size_t captures = 0;
  const TaskWorkerFactory make = sweep_workers(
      [&](const scenarios::Scenario& scenario) {
        return std::make_unique<CountedWorld>(scenario, captures, "yoon2021_both");
      },
      nullptr);
  EXPECT_THAT(
      [&] { ThreadFarm(make).run(sweep_tasks.tasks(), [](std::size_t, const std::string&) {}); },
      testing::ThrowsMessage<std::runtime_error>(
          testing::HasSubstr(R"(18cam_6host_45fps {"pipeline":"yoon2021_both","seed":9,"values":)"
                             R"([["/evaluation/gathering_interval_periods","0.1"]]}: )"
                             "18cam_6host_45fps, pipeline yoon2021_both, seed 9: no world")));
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
  std::vector<SweepScore> scores(4);
  const SweepTasks tasks(plan, all_runs(plan));
  ThreadFarm(make).run(tasks.tasks(), [&](std::size_t task, const std::string& answer) {
    tasks.each_run(task, answer, [&](std::size_t run, const std::string& text) {
      const auto score = score_of(text, plan.kind);
      ASSERT_TRUE(score) << text;
      EXPECT_FALSE(score_of(text)) << "of captures: " << text;
      scores[run] = *score;
    });
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
