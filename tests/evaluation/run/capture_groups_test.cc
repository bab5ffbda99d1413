// Who shares a capture, and what it costs a pipeline: nothing.
#include "evaluation/run/capture_groups.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "recording/event.h"
#include "recording/event_text.h"
#include "recording/forwarding_sink.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/evaluation/test_scenario.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsNan;
using ::testing::Pair;

scenarios::Scenario scenario_of(std::vector<scenarios::Pipeline> pipelines) {
  scenarios::Scenario scenario = test_scenario();
  scenario.pipelines = std::move(pipelines);
  return scenario;
}

// Two that exchange messages, two that do nothing, and one that starts with other clocks.
scenarios::Scenario five() {
  return scenario_of({{"a", "yoon2021_both", "regression_30", "yoon2021"},
                      {"b", "free_running", "raw_arrival", "yoon2021"},
                      {"c", "yoon2021_both", "raw_arrival", "yoon2021"},
                      {"d", "free_running", "regression_30", "epsilon"},
                      {"e", "oracle", "regression_30", "yoon2021"}});
}

void take_load(scenarios::Scenario& scenario) {
  scenario.hosts.send_cost_session_exponential_ms = 0;
  scenario.hosts.clock.set_cost_session_log_sigma = 0;
  scenario.network.latency_session_exponential_ms = 0;
}

CaptureGroups groups_of(const scenarios::Scenario& scenario) {
  return capture_groups(scenario, choose_pipelines(scenario, {}));
}

TEST(CaptureGroups, WhereEachPipelineHasALoadOnlyIdleOnesShare) {
  const scenarios::Scenario scenario = five();
  ASSERT_TRUE(scenario.draws_load());
  EXPECT_THAT(groups_of(scenario),
              ElementsAre(ElementsAre(0), ElementsAre(1, 3), ElementsAre(2), ElementsAre(4)));
}

TEST(CaptureGroups, WithoutLoadThoseOfOneHostSyncShare) {
  scenarios::Scenario scenario = five();
  take_load(scenario);
  EXPECT_THAT(groups_of(scenario),
              ElementsAre(ElementsAre(0, 2), ElementsAre(1, 3), ElementsAre(4)));
  for (double* const parameter : {&scenario.hosts.send_cost_session_exponential_ms,
                                  &scenario.hosts.clock.set_cost_session_log_sigma,
                                  &scenario.network.latency_session_exponential_ms}) {
    *parameter = 0.1;
    EXPECT_EQ(groups_of(scenario).size(), 4U);
    *parameter = 0;
  }
}

TEST(CaptureGroups, ThoseOfOneNameHaveOneLoad) {
  EXPECT_THAT(groups_of(scenario_of({{"a", "yoon2021_both", "regression_30", "yoon2021"},
                                     {"a", "yoon2021_both", "regression_30", "oracle"}})),
              ElementsAre(ElementsAre(0, 1)));
}

TEST(CaptureGroups, OtherParametersAreAnotherCapture) {
  scenarios::Scenario scenario = five();
  take_load(scenario);
  std::vector<PipelineChoice> choices = choose_pipelines(scenario, {"a", "c"});
  ASSERT_EQ(capture_groups(scenario, choices).size(), 1U);
  scenario.algorithms["yoon2021"]["stamps"] = 7.0;
  choices[1] = choose_pipelines(scenario, {"c"}).front();
  EXPECT_EQ(capture_groups(scenario, choices).size(), 2U);
}

// What a world with these changes records of a host synchronisation at seed 3, line by line.
std::vector<std::string> recorded_by(const std::vector<scenarios::Override>& changes,
                                     const PipelineChoice& choice) {
  std::vector<scenarios::Override> overrides = {{"/timeline/frames", "30"}};
  overrides.insert(overrides.end(), changes.begin(), changes.end());
  const scenarios::Scenario world = scenarios::load_scenario("18cam_6host_45fps", overrides);
  KeptRecording recording;
  record_run(*sim::make_simulation(world), choice, /*seed=*/3, recording);
  const RigLayout& layout = recording.layout();
  std::vector<std::string> lines = {
      fmt::format("{} {} {}", layout.frame_rate_hz, layout.first_pulse, layout.pulses)};
  for (const KeptEvent& event : recording.events()) lines.push_back(to_line(event));
  return lines;
}

TEST(ScoringAlone, NoWorldReadsWhatIsSoCalled) {
  const scenarios::Scenario scenario = scenarios::load_scenario("18cam_6host_45fps");
  const PipelineChoice choice = choose_pipelines(scenario, {"yoon2021_both"}).front();
  const std::vector<std::string> as_it_is = nonempty(recorded_by({}, choice));
  for (const scenarios::Override& change :
       std::vector<scenarios::Override>{{"/evaluation/gathering_interval_periods", "0.07"},
                                        {"/evaluation/gathering_queue_frames", "3"},
                                        {"/evaluation/rmdv_median", "mean_of_middle_two"},
                                        {"/algorithms/yoon2021/stamps", "7"},
                                        {"/algorithms/kalman/gate", "2"},
                                        {"/algorithms/approximate_time/queue", "3"}}) {
    EXPECT_TRUE(is_scoring_alone(change.pointer)) << change.pointer;
    EXPECT_EQ(recorded_by({change}, choice), as_it_is) << change.pointer;
  }
  EXPECT_NE(recorded_by({{"/usb/delivery_jitter_transfers", "0.9"}}, choice), as_it_is);
}

TEST(ScoringAlone, OtherMembersAreNotSoCalled) {
  for (const char* const pointer :
       {"/evaluation/stream", "/usb/delivery_jitter_transfers", "/hosts/count", "/timeline/frames",
        "/pipelines/0/host_sync", "/evaluation/gathering_interval", "/algorithms"}) {
    EXPECT_FALSE(is_scoring_alone(pointer)) << pointer;
  }
}

// The two pipelines of the test scenario share: both leave the clocks as they were set last.
class CountedSource final : public RecordingSource {
 public:
  CountedSource(std::vector<std::pair<std::string, std::uint64_t>>& calls, bool fails)
      : calls_(calls), fails_(fails) {}
  RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
    calls_.emplace_back(request.pipeline, request.seed);
    if (fails_) throw RecordingFailed("host2 could not be reached");
    return TestSource().record(request, sink);
  }

 private:
  std::vector<std::pair<std::string, std::uint64_t>>& calls_;
  bool fails_;
};

struct Shared {
  Results results;
  std::vector<std::pair<std::string, std::uint64_t>> calls{};
  std::vector<std::uint64_t> progress{};
};

Shared shared_run(bool fails) {
  Shared shared;
  shared.results = evaluate(
      test_scenario(), [&] { return std::make_unique<CountedSource>(shared.calls, fails); },
      {.seeds = 2, .jobs = 1, .share_captures = true},
      [&](std::uint64_t done, std::uint64_t total) {
        EXPECT_EQ(total, 4U);
        shared.progress.push_back(done);
      });
  return shared;
}

TEST(SharedCaptures, OneCaptureOfASeedScoresBoth) {
  const Shared shared = shared_run(false);
  EXPECT_THAT(shared.calls, ElementsAre(Pair("arrival", 1), Pair("arrival", 2)));
  EXPECT_THAT(shared.progress, ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(shared.results.performance.events, 101U + 102U);
  for (const Row& row : shared.results.rows) {
    ASSERT_EQ(row.seeds.size(), 2U);
    EXPECT_EQ(row.seeds[1].seed, 2U);
    EXPECT_EQ(row.seeds[1].cost.events, 102U);
  }
  EXPECT_DOUBLE_EQ(shared.results.rows[0].amd_ms.values[1], 2);
  EXPECT_NEAR(shared.results.rows[1].amd_ms.values[1], 2, 1e-6);
}

TEST(SharedCaptures, ACaptureThatFailsIsMissingFromAllItsRows) {
  const Shared shared = shared_run(true);
  EXPECT_THAT(shared.progress, ElementsAre(1, 2, 3, 4));
  for (const Row& row : shared.results.rows) {
    EXPECT_THAT(row.amd_ms.values, ElementsAre(IsNan(), IsNan()));
    EXPECT_THAT(row.notes, Contains(HasSubstr("host2 could not be reached")));
  }
}

// A narrower interval and another median: what either gives alone, from one capture.
TEST(SharedCaptures, EachIsScoredAsItsOwnScenarioSays) {
  std::vector<PipelineChoice> choices;
  std::vector<std::vector<double>> alone;
  for (const double periods : {0.5, 0.05}) {
    scenarios::Scenario scenario = test_scenario();
    scenario.pipelines.resize(1);
    scenario.evaluation.gathering_interval_periods = periods;
    const Results results = evaluate(
        scenario, [] { return std::make_unique<TestSource>(); }, {.seeds = 3, .jobs = 1}, nullptr);
    alone.push_back({results.rows[0].margin_ms, results.rows[0].recall});
    choices.push_back(choose_pipelines(scenario, {}).front());
    choices.back().scored_in = std::make_shared<const scenarios::Scenario>(scenario);
  }
  EXPECT_NE(alone[0], alone[1]);
  std::vector<std::pair<std::string, std::uint64_t>> calls;
  const Results together = evaluate_choices(
      test_scenario(), choices, [&] { return std::make_unique<CountedSource>(calls, false); },
      {.seeds = 3, .jobs = 1, .share_captures = true}, nullptr);
  EXPECT_EQ(calls.size(), 3U);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const Row& row = together.rows[i];
    EXPECT_THAT(alone[i], ElementsAre(row.margin_ms, row.recall));
  }
}

// A view that cannot go on, of the second pipeline alone.
class BrokenSink final : public ForwardingSink {
 public:
  using ForwardingSink::ForwardingSink;
  void on_event(const RecordingEvent& event) override {
    if (std::holds_alternative<PulseTruth>(event)) throw std::runtime_error("a pulse too many");
  }
};

TEST(SharedCaptures, AnErrorNamesThePipelineThatHadIt) {
  const scenarios::Scenario scenario = test_scenario();
  std::vector<PipelineChoice> choices = choose_pipelines(scenario, {});
  choices[1].view = [](RecordingSink& sink) { return std::make_unique<BrokenSink>(sink); };
  try {
    evaluate_choices(
        scenario, choices, [] { return std::make_unique<TestSource>(); },
        {.seeds = 2, .jobs = 1, .share_captures = true}, nullptr);
    FAIL() << "nothing was thrown";
  } catch (const EvaluationFailed& failed) {
    EXPECT_THAT(failed.what(), HasSubstr("pipeline smooth, seed 1: a pulse too many"));
    EXPECT_EQ(failed.finished().rows[0].seeds.size(), 1U);
    EXPECT_EQ(failed.finished().rows[1].seeds.size(), 0U);
  }
}

}  // namespace
}  // namespace simbench::evaluation
