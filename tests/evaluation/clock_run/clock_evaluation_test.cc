#include "evaluation/clock_run/clock_evaluation.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using scenarios::InputError;
using scenarios::Scenario;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// Two hosts, whose slave is ahead by `seed` microseconds, in "ntp" by ten times that, and a little
// more each second.
class TestClocks final : public ClockSource {
 public:
  ClockCost run(const ClockRequest& request, ClockSink& sink) override {
    if (request.seed == kBadSeed) throw std::runtime_error("out of luck");
    EXPECT_NE(request.host_sync, nullptr);
    const double scale = (request.pipeline == "ntp" ? 10e-6 : 1e-6);
    const Nanoseconds end = request.duration + request.master_lost_for + request.recovery;
    for (Nanoseconds at{}; at <= end; at += request.interval) {
      if (request.cancel != nullptr && *request.cancel) throw RecordingCancelled();
      const double slow = 1e-9 * static_cast<double>(at.count() / 1'000'000'000 % 7);
      const std::vector<double> errors_s = {0, scale * static_cast<double>(request.seed) + slow};
      sink.on_errors(TrueTime(at), errors_s);
    }
    return {.events = 100 + request.seed, .messages = 40 * request.seed, .trace_hash = 1};
  }

  static constexpr std::uint64_t kBadSeed = 99;
};

std::unique_ptr<ClockSource> test_clocks() { return std::make_unique<TestClocks>(); }

Scenario two_clocks() {
  Scenario scenario = scenarios::load_scenario("6host_star");
  scenario.hosts.count = 2;
  return scenario;
}

ClockOptions brief_run() {
  return {.duration_s = 40,
          .from_s = 5,
          .first_seed = 3,
          .seeds = 3,
          .jobs = 1,
          .pipelines = {"chrony", "ntp"}};
}

TEST(ClockEvaluation, ARowPerPipelineAndAValuePerSeed) {
  const ClockResults all = evaluate_clocks(two_clocks(), test_clocks, brief_run(), nullptr);
  const Results& results = all.results;
  EXPECT_EQ(results.kind, ResultKind::kClockRuns);
  EXPECT_EQ(results.clock_period, (ClockPeriod{.from_s = 5, .duration_s = 40}));
  EXPECT_EQ(results.scenario, "6host_star");
  EXPECT_EQ(results.first_seed, 3U);
  EXPECT_EQ(results.seed_count, 3U);
  EXPECT_THAT(results.warnings, IsEmpty());
  ASSERT_EQ(results.rows.size(), 2U);
  EXPECT_EQ(results.rows[0].pipeline, "chrony");
  EXPECT_EQ(results.rows[1].host_sync, "ntp");
  EXPECT_THAT(results.rows[1].packets_per_s.values, ElementsAre(3, 4, 5));
  EXPECT_THAT(results.rows[1].constant_te_ms.values,
              ElementsAre(testing::DoubleNear(0.03, 6e-6), testing::DoubleNear(0.04, 6e-6),
                          testing::DoubleNear(0.05, 6e-6)));
  EXPECT_EQ(results.performance.events, 2 * (103U + 104U + 105U));
  EXPECT_DOUBLE_EQ(results.performance.simulated_seconds, 6 * (40 + 600 + 3600));
  EXPECT_GT(results.performance.cpu_seconds, 0);
  ASSERT_EQ(all.curves.size(), 2U);
  EXPECT_NEAR(all.curves[0].mtie_ms.back().value, 6e-6, 1e-12);
  ASSERT_EQ(all.readings.size(), 2U);
  EXPECT_EQ(all.readings[1].errors_s[1].size(), 36U);
  EXPECT_NEAR(all.readings[1].errors_s[1][2], 30e-6, 1e-15) << "of the first seed, at 7 s";
}

TEST(ClockEvaluation, TheNumberOfThreadsChangesNothing) {
  ClockOptions options = brief_run();
  options.seeds = 12;
  const ClockResults one = evaluate_clocks(two_clocks(), test_clocks, options, nullptr);
  options.jobs = 4;
  const ClockResults four = evaluate_clocks(two_clocks(), test_clocks, options, nullptr);
  ASSERT_EQ(one.results.rows.size(), four.results.rows.size());
  for (std::size_t row = 0; row < one.results.rows.size(); ++row) {
    for (const Metric& metric : nonempty(metrics(ResultKind::kClockRuns))) {
      const Series& a = metric.series(one.results.rows[row]);
      EXPECT_THAT(metric.series(four.results.rows[row]).values,
                  testing::Pointwise(testing::NanSensitiveDoubleEq(), a.values))
          << metric.id;
    }
    EXPECT_EQ(one.readings[row].errors_s, four.readings[row].errors_s);
    for (std::size_t i = 0; i < one.curves[row].adev.size(); ++i) {
      EXPECT_EQ(one.curves[row].adev[i].value, four.curves[row].adev[i].value);
    }
  }
  EXPECT_EQ(one.results.performance.events, four.results.performance.events);
}

TEST(ClockEvaluation, ProgressIsTold) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> told;
  evaluate_clocks(two_clocks(), test_clocks, brief_run(),
                  [&](std::uint64_t done, std::uint64_t all) { told.emplace_back(done, all); });
  ASSERT_EQ(told.size(), 6U);
  EXPECT_EQ(told.back(), std::make_pair(std::uint64_t{6}, std::uint64_t{6}));
}

TEST(ClockEvaluation, WithoutStatedPipelinesThereIsARowForEachHostSync) {
  const Scenario scenario = scenarios::load_scenario("18cam_6host_45fps_lan");
  ClockOptions options{.duration_s = 10, .from_s = 1, .seeds = 1, .jobs = 1};
  const ClockPipelines chosen = clock_pipelines(scenario, options);
  std::set<std::string> host_syncs;
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    host_syncs.insert(pipeline.host_sync);
  }
  EXPECT_LT(host_syncs.size(), scenario.pipelines.size());
  EXPECT_EQ(chosen.names.size(), host_syncs.size());
  EXPECT_THAT(chosen.left_out, IsEmpty());
  EXPECT_THAT(chosen.names, testing::Contains("two_way_hull")) << "the first that has it";
  EXPECT_THAT(chosen.names, testing::Not(testing::Contains("best_online")));
  options.pipelines = {"best_online", "two_way_hull"};
  EXPECT_THAT(clock_pipelines(scenario, options).names, ElementsAre("best_online", "two_way_hull"));
}

TEST(ClockEvaluation, WhatNeedsFramesOrTheTriggerIsLeftOutOrRefused) {
  Scenario scenario = scenarios::load_scenario("leaderboard_lan");
  std::vector<scenarios::Pipeline> kept;
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    if (pipeline.host_sync == "common_view" || pipeline.host_sync == "trigger_wired" ||
        pipeline.host_sync == "chrony") {
      kept.push_back(pipeline);
      kept.back().name = pipeline.host_sync + std::to_string(kept.size());
    }
  }
  scenario.pipelines = kept;
  const ClockOptions options{.duration_s = 10, .from_s = 1, .seeds = 1, .jobs = 1};
  const ClockResults all = evaluate_clocks(scenario, test_clocks, options, nullptr);
  ASSERT_EQ(all.results.rows.size(), 1U);
  EXPECT_EQ(all.results.rows[0].host_sync, "chrony");
  EXPECT_THAT(all.results.warnings,
              testing::Contains(AllOf(HasSubstr("host_sync \"common_view\" needs the frames of "
                                                "cameras, which a run of the clocks alone"),
                                      HasSubstr("; left out"))));
  EXPECT_THAT(all.results.warnings,
              testing::Contains(HasSubstr("\"trigger_wired\" needs the trigger's pulses")));
}

// What is wrong with the options.
std::string refusal_of(const Scenario& scenario, const ClockOptions& options) {
  std::string checked = "nothing";
  try {
    check_clock_options(scenario, options);
  } catch (const InputError& error) {
    checked = error.what();
  }
  try {
    evaluate_clocks(
        scenario,
        []() -> std::unique_ptr<ClockSource> { throw std::logic_error("refused too late"); },
        options, nullptr);
  } catch (const InputError& error) {
    EXPECT_EQ(checked, error.what());
  } catch (const std::logic_error&) {
    EXPECT_EQ(checked, "nothing");
  }
  return checked;
}

TEST(ClockEvaluation, RefusesSpansWithoutReadings) {
  const Scenario scenario = two_clocks();
  const auto refusal = [&](std::uint64_t from_s, std::uint64_t duration_s) {
    ClockOptions options = brief_run();
    options.from_s = from_s;
    options.duration_s = duration_s;
    return refusal_of(scenario, options);
  };
  EXPECT_EQ(refusal(300, 304), "nothing");
  EXPECT_EQ(refusal(0, 4), "nothing");
  EXPECT_EQ(refusal(300, 303),
            "--duration-s: found 303, allowed: at least 304, 4 readings of a second behind "
            "--from-s");
  EXPECT_EQ(refusal(300, 300), "--from-s: found 300, allowed: less than --duration-s, 300");
  EXPECT_EQ(refusal(36'001, 36'000),
            "--from-s: found 36001, allowed: less than --duration-s, 36000");
  EXPECT_EQ(refusal(300, kLongestClockRunS), "nothing");
  EXPECT_EQ(refusal(300, kLongestClockRunS + 1),
            "--duration-s: found 31000001, allowed: at most 31000000");
}

TEST(ClockEvaluation, RefusesPipelinesThatCannotRun) {
  Scenario scenario = two_clocks();
  ClockOptions options = brief_run();
  options.pipelines = {"cristian"};
  EXPECT_THAT(refusal_of(scenario, options), HasSubstr("cristian"));
  Scenario of_frames = scenarios::load_scenario("leaderboard_lan");
  std::erase_if(of_frames.pipelines, [](const scenarios::Pipeline& pipeline) {
    return pipeline.host_sync != "common_view";
  });
  ASSERT_FALSE(of_frames.pipelines.empty());
  options.pipelines.clear();
  EXPECT_THAT(refusal_of(of_frames, options),
              AllOf(StartsWith("the scenario has no pipeline whose hosts run without cameras: "),
                    HasSubstr("needs the frames of cameras")));
  options.pipelines = {of_frames.pipelines.front().name};
  EXPECT_THAT(refusal_of(of_frames, options),
              AllOf(StartsWith("--pipelines: pipeline"), HasSubstr("needs the frames of cameras")));
}

TEST(ClockEvaluation, RefusesAHostAlone) {
  Scenario scenario = two_clocks();
  scenario.hosts.count = 1;
  EXPECT_THAT(refusal_of(scenario, brief_run()), StartsWith("/hosts/count: found 1, allowed"));
}

TEST(ClockEvaluation, AFailureNamesItsRun) {
  ClockOptions options = brief_run();
  options.first_seed = TestClocks::kBadSeed - 1;
  options.jobs = 2;
  try {
    evaluate_clocks(two_clocks(), test_clocks, options, nullptr);
    FAIL() << "nothing was thrown";
  } catch (const EvaluationFailed& error) {
    EXPECT_THAT(error.what(), StartsWith("6host_star, pipeline chrony, seed 99: out of luck"));
  }
}

TEST(ClockEvaluation, ACancelledOneSaysSo) {
  for (const std::uint64_t before : {0, 1}) {
    std::atomic<bool> cancel = before == 0;
    ClockOptions options = brief_run();
    options.cancel = &cancel;
    EXPECT_THROW(evaluate_clocks(two_clocks(), test_clocks, options,
                                 [&](std::uint64_t, std::uint64_t) { cancel = true; }),
                 EvaluationCancelled);
  }
  struct Interrupted final : ClockSource {
    explicit Interrupted(std::atomic<bool>& flag) : cancel(flag) {}
    ClockCost run(const ClockRequest&, ClockSink&) override {
      cancel = true;
      throw RecordingCancelled();
    }
    std::atomic<bool>& cancel;
  };
  std::atomic<bool> cancel = false;
  ClockOptions options = brief_run();
  options.cancel = &cancel;
  EXPECT_THROW(
      evaluate_clocks(
          two_clocks(), [&] { return std::make_unique<Interrupted>(cancel); }, options, nullptr),
      EvaluationCancelled);
}

}  // namespace
}  // namespace simbench::evaluation
