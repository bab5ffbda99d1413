#include "evaluation/run/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "evaluation/scoring/rows.h"
#include "evaluation/statistics/statistics.h"
#include "recording/version.h"
#include "scenarios/loader.h"
#include "tests/evaluation/test_scenario.h"

namespace simbench::evaluation {
namespace {

using scenarios::InputError;
using scenarios::Scenario;
using ::testing::AllOf;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsNan;
using ::testing::Pointwise;

std::unique_ptr<RecordingSource> test_source() { return std::make_unique<TestSource>(); }

void expect_equal(const Row& a, const Row& b) {
  EXPECT_EQ(a.pipeline, b.pipeline);
  EXPECT_THAT(a.amd_ms.values, Pointwise(DoubleEq(), b.amd_ms.values));
  EXPECT_THAT(a.rmdv_ms.values, Pointwise(DoubleEq(), b.rmdv_ms.values));
  EXPECT_THAT(a.bias_ms.values, Pointwise(DoubleEq(), b.bias_ms.values));
  EXPECT_EQ(a.margin_ms, b.margin_ms);
  EXPECT_EQ(a.evaluated_pulses, b.evaluated_pulses);
  ASSERT_EQ(a.seeds.size(), b.seeds.size());
  for (std::size_t i = 0; i < a.seeds.size(); ++i) {
    EXPECT_EQ(a.seeds[i].seed, b.seeds[i].seed);
    EXPECT_EQ(a.seeds[i].sets.pure, b.seeds[i].sets.pure);
    EXPECT_EQ(a.seeds[i].cost.trace_hash, b.seeds[i].cost.trace_hash);
  }
}

TEST(EvaluateTest, ARowPerPipelineAndAValuePerSeed) {
  const Results results =
      evaluate(test_scenario(), test_source, {.first_seed = 2, .seeds = 3, .jobs = 1}, nullptr);
  EXPECT_EQ(results.scenario, "test");
  EXPECT_EQ(results.first_seed, 2U);
  EXPECT_EQ(results.seed_count, 3U);
  ASSERT_EQ(results.rows.size(), 2U);
  const Row& row = results.rows[0];
  EXPECT_EQ(row.pipeline, "arrival");
  EXPECT_EQ(row.device_time, "raw_arrival");
  EXPECT_THAT(row.amd_ms.values, ElementsAre(DoubleEq(2), DoubleEq(3), DoubleEq(4)));
  EXPECT_DOUBLE_EQ(row.amd_ms.median, 3);
  EXPECT_EQ(row.evaluated_pulses, 30);
  EXPECT_EQ(row.frames.expected, 120);
  EXPECT_EQ(row.frames.dropped, 0);
  EXPECT_DOUBLE_EQ(row.precision, 1);
  EXPECT_DOUBLE_EQ(row.recall, 1);
  // T_int is 10 ms; of 30 spreads, ten each of 2, 3 and 4 ms, the 99.9 % quantile is 4.
  EXPECT_DOUBLE_EQ(row.margin_ms, 6);
  EXPECT_FALSE(row.published.has_value());
  EXPECT_NEAR(results.rows[1].amd_ms.median, 3.5, 1e-6);
  EXPECT_EQ(results.claims.size(), 13U);
  EXPECT_THAT(results.warnings, IsEmpty());
}

TEST(EvaluateTest, PerformanceIsTheSumOfAllRecordings) {
  const Results results = evaluate(test_scenario(), test_source, {.seeds = 2, .jobs = 2}, nullptr);
  EXPECT_EQ(results.performance.events, 2 * (101U + 102U));
  EXPECT_DOUBLE_EQ(results.performance.simulated_seconds, 8);
  EXPECT_GT(results.performance.cpu_seconds, 0);
  EXPECT_GT(results.performance.wall_seconds, 0);
  EXPECT_DOUBLE_EQ(results.performance.events_per_second, 406 / results.performance.wall_seconds);
}

TEST(EvaluateTest, ThreadsDoNotChangeResults) {
  const Scenario scenario = test_scenario();
  const Results one = evaluate(scenario, test_source, {.seeds = 16, .jobs = 1}, nullptr);
  for (const unsigned jobs : {0U, 2U, 5U, 64U}) {
    const Results many = evaluate(scenario, test_source, {.seeds = 16, .jobs = jobs}, nullptr);
    ASSERT_EQ(many.rows.size(), one.rows.size());
    for (std::size_t i = 0; i < one.rows.size(); ++i) expect_equal(one.rows[i], many.rows[i]);
  }
}

TEST(EvaluateTest, PipelinesByNameInTheGivenOrder) {
  const Results results = evaluate(test_scenario(), test_source,
                                   {.seeds = 1, .pipelines = {"smooth", "arrival"}}, nullptr);
  ASSERT_EQ(results.rows.size(), 2U);
  EXPECT_EQ(results.rows[0].pipeline, "smooth");
  EXPECT_EQ(results.rows[1].pipeline, "arrival");
}

TEST(EvaluateTest, KeepsPulsesIfAsked) {
  const Scenario scenario = test_scenario();
  EXPECT_EQ(evaluate(scenario, test_source, {.seeds = 1, .keep_pulses = true}, nullptr)
                .rows[0]
                .seeds[0]
                .pulses.size(),
            10U);
  EXPECT_THAT(evaluate(scenario, test_source, {.seeds = 1}, nullptr).rows[0].seeds[0].pulses,
              IsEmpty());
}

// The floor is that of links which are drawn, each by itself.
TEST(EvaluateTest, HasNoFloorWhereAsymmetriesAreStatedOrOfPorts) {
  const auto has_floor = [](const Scenario& scenario) {
    return evaluate(scenario, test_source, {.seeds = 1}, nullptr).asymmetry_floor.has_value();
  };
  Scenario scenario = test_scenario();
  scenario.network.asymmetry_sigma_ms = 0.01;
  scenario.network.links = {{.host = 1, .latency_fixed_ms = 3}};
  EXPECT_TRUE(has_floor(scenario));
  Scenario ports = scenario;
  ports.network.port_asymmetry_sigma_ms = 0.01;
  EXPECT_FALSE(has_floor(ports));
  scenario.network.links[0].asymmetry_ms = 0;
  EXPECT_FALSE(has_floor(scenario));
}

TEST(EvaluateTest, ProgressCountsEveryJob) {
  std::vector<std::uint64_t> done;
  evaluate(test_scenario(), test_source, {.seeds = 8, .jobs = 3},
           [&done](std::uint64_t count, std::uint64_t total) {
             EXPECT_EQ(total, 16U);
             done.push_back(count);
           });
  ASSERT_EQ(done.size(), 16U);
  for (std::size_t i = 0; i < done.size(); ++i) EXPECT_EQ(done[i], i + 1);
}

// Fails in one pipeline of one seed.
class FailingSource final : public RecordingSource {
 public:
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    if (request.seed == 3 && request.pipeline == "smooth")
      throw std::runtime_error("no more events");
    return TestSource().record(request, sink);
  }
};

TEST(EvaluateTest, AFailedJobNamesItselfAndKeepsTheFinishedOnes) {
  try {
    evaluate(
        test_scenario(), [] { return std::make_unique<FailingSource>(); }, {.seeds = 5, .jobs = 1},
        nullptr);
    FAIL() << "nothing was thrown";
  } catch (const EvaluationFailed& failed) {
    EXPECT_THAT(failed.what(),
                AllOf(HasSubstr("test"), HasSubstr("pipeline smooth"), HasSubstr("seed 3"),
                      HasSubstr("no more events"), HasSubstr(std::string(commit()))));
    ASSERT_EQ(failed.finished().rows.size(), 2U);
    EXPECT_EQ(failed.finished().rows[0].seeds.size(), 3U);
    EXPECT_EQ(failed.finished().rows[1].seeds.size(), 2U);
    EXPECT_THAT(failed.finished().claims, IsEmpty());
  }
}

TEST(EvaluateTest, AFailureAmongManyThreadsIsReported) {
  EXPECT_THROW(evaluate(
                   test_scenario(), [] { return std::make_unique<FailingSource>(); },
                   {.seeds = 20, .jobs = 4}, nullptr),
               EvaluationFailed);
}

TEST(EvaluateTest, WhatTheFactoryThrowsPassesThrough) {
  const SourceFactory factory = []() -> std::unique_ptr<RecordingSource> {
    throw InputError("/usb: found nothing");
  };
  EXPECT_THROW(evaluate(test_scenario(), factory, {.seeds = 4, .jobs = 2}, nullptr), InputError);
}

TEST(EvaluateTest, CancelEndsItWithWhatIsDone) {
  std::atomic<bool> cancel = false;
  try {
    evaluate(test_scenario(), test_source, {.seeds = 50, .jobs = 1, .cancel = &cancel},
             [&cancel](std::uint64_t done, std::uint64_t) { cancel = done == 4; });
    FAIL() << "nothing was thrown";
  } catch (const EvaluationCancelled& cancelled) {
    EXPECT_EQ(cancelled.finished().rows[0].seeds.size(), 2U);
    EXPECT_EQ(cancelled.finished().rows[1].seeds.size(), 2U);
  }
}

TEST(EvaluateTest, PublishedValuesAreComparedWithTheSeeds) {
  Scenario scenario = test_scenario();
  scenario.published["arrival"] = {.amd_ms = 2.5, .rmdv_ms = 2.4};
  const Results results = evaluate(scenario, test_source, {.seeds = 4}, nullptr);
  ASSERT_TRUE(results.rows[0].published.has_value());
  const PublishedComparison& published = *results.rows[0].published;
  EXPECT_DOUBLE_EQ(published.amd_ms, 2.5);
  EXPECT_EQ(placement_of(published.amd_percentile), Placement::kInside);
  EXPECT_FALSE(published.rmdv_attainable);  // 0.96 of AMD
  EXPECT_DOUBLE_EQ(published.amd_percentile.percent, 50);
  // One of four late by s: RMDV is s / 2, at most 2.
  EXPECT_DOUBLE_EQ(published.rmdv_percentile.percent, 100);
  EXPECT_FALSE(results.rows[1].published.has_value());
}

TEST(EvaluateTest, PublishedFiguresAreComparedWithTheSeeds) {
  Scenario scenario = test_scenario();
  scenario.published_figures = {{.pipeline = "arrival", .metric = "amd_ms", .at_most = 2.5},
                                {.pipeline = "smooth", .metric = "amd_ms", .value = 100}};
  const Results results = evaluate(scenario, test_source, {.seeds = 4}, nullptr);
  ASSERT_EQ(results.published_figures.size(), 2U);
  EXPECT_DOUBLE_EQ(results.published_figures[0].kept.percent, 50);  // AMD is the seed in ms
  EXPECT_DOUBLE_EQ(results.published_figures[1].percentile.percent, 100);
  const Results one =
      evaluate(scenario, test_source, {.seeds = 4, .pipelines = {"smooth"}}, nullptr);
  ASSERT_EQ(one.published_figures.size(), 1U);
  EXPECT_EQ(one.published_figures[0].figure.pipeline, "smooth");
}

TEST(EvaluateTest, PublishedRmdvIsAttainableUpToTheBound) {
  Row row;
  row.amd_ms = make_series({1, 2});
  row.rmdv_ms = make_series({1, 2});
  const RowSetting eighteen = {.gathering_interval_ms = 10, .sources = 18};
  EXPECT_TRUE(compare({.amd_ms = 3.9161, .rmdv_ms = 2.7667}, row, eighteen).rmdv_attainable);
  EXPECT_FALSE(compare({.amd_ms = 4.2783, .rmdv_ms = 3.3137}, row, eighteen).rmdv_attainable);
  EXPECT_FALSE(compare({.amd_ms = 2.4380, .rmdv_ms = 1.8044}, row, eighteen).rmdv_attainable);
  RowSetting mean_of_two = eighteen;
  mean_of_two.median = MedianKind::kMeanOfMiddleTwo;
  EXPECT_FALSE(compare({.amd_ms = 3.9161, .rmdv_ms = 2.7667}, row, mean_of_two).rmdv_attainable);
}

TEST(EvaluateTest, ARowOfNothingIsNan) {
  const Row row = make_row({}, {}, {.gathering_interval_ms = 10, .sources = 18});
  EXPECT_THAT(row.precision, IsNan());
  EXPECT_THAT(row.recall, IsNan());
  EXPECT_THAT(row.margin_ms, IsNan());
  EXPECT_THAT(row.amd_ms.median, IsNan());
}

// Genlock cameras, of which one starts a pulse late.
class LateStartSource final : public RecordingSource {
 public:
  RecordingCost record(const RecordingRequest&, RecordingSink& sink) override {
    TestCapture capture(2, 2);
    capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
      return camera == 1 && pulse == 0;
    };
    capture.record(sink);
    return {};
  }
};

TEST(EvaluateTest, WarnsWhenGenlockOrderIsNotTheTruth) {
  Scenario scenario = test_scenario();
  scenario.cameras.sync_mode = scenarios::SyncMode::kGenlock;
  const Results results = evaluate(
      scenario, [] { return std::make_unique<LateStartSource>(); },
      {.seeds = 2, .pipelines = {"arrival"}}, nullptr);
  ASSERT_EQ(results.warnings.size(), 1U);
  EXPECT_THAT(results.warnings[0], HasSubstr("up to 12 frames a run, in 2 of 2 seeds"));
  EXPECT_EQ(results.rows[0].seeds[0].genlock_index_errors, 12);
}

TEST(GrowingEvaluationTest, MoreSeedsGiveWhatAllAtOnceGive) {
  const Scenario scenario = test_scenario();
  GrowingEvaluation growing(scenario, test_source, {.first_seed = 3});
  for (const std::uint64_t seeds : {2, 5, 4, 9}) {
    const Results& grown = growing.up_to(seeds);
    const std::uint64_t expected = seeds == 4 ? 5 : seeds;  // fewer are as many as before
    const Results at_once = evaluate(
        scenario, test_source, {.first_seed = 3, .seeds = expected, .keep_pulses = true}, nullptr);
    EXPECT_EQ(grown.seed_count, expected);
    ASSERT_EQ(grown.rows.size(), at_once.rows.size());
    for (std::size_t row = 0; row < grown.rows.size(); ++row) {
      expect_equal(grown.rows[row], at_once.rows[row]);
      ASSERT_FALSE(grown.rows[row].seeds.empty());
      EXPECT_EQ(grown.rows[row].seeds.front().pulses.size(),
                at_once.rows[row].seeds.front().pulses.size());
    }
    EXPECT_EQ(grown.performance.events, at_once.performance.events);
  }
}

// A source that counts its captures.
TEST(GrowingEvaluationTest, NoSeedRunsTwice) {
  struct Counting final : RecordingSource {
    explicit Counting(std::vector<std::uint64_t>& its_seeds) : seeds(its_seeds) {}
    RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
      seeds.push_back(request.seed);
      return source.record(request, sink);
    }
    TestSource source;
    std::vector<std::uint64_t>& seeds;
  };
  std::vector<std::uint64_t> seeds;
  const Scenario scenario = test_scenario();
  GrowingEvaluation growing(scenario, [&] { return std::make_unique<Counting>(seeds); },
                            {.jobs = 1, .pipelines = {"arrival"}});
  growing.up_to(2);
  growing.up_to(5);
  EXPECT_THAT(seeds, ElementsAre(1, 2, 3, 4, 5));
}

}  // namespace
}  // namespace simbench::evaluation
