#include "evaluation/run/pipeline_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/device_time/yoon2021.h"
#include "evaluation/run/evaluate.h"
#include "recording/event.h"
#include "scenarios/loader.h"
#include "tests/evaluation/test_scenario.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using scenarios::InputError;
using scenarios::Scenario;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kLag = "test_lag";

// An estimator with a parameter, as a user would register it.
class Lag final : public DeviceTimeEstimator {
 public:
  explicit Lag(double lag_ms) : lag_(from_ms(lag_ms)) {}
  GlobalTime stamp(const DeviceSample& sample) override {
    return GlobalTime(sample.arrival.time_since_epoch() + lag_);
  }

 private:
  Nanoseconds lag_;
};

void register_lag() {
  if (find_algorithm<DeviceTimeEntry>(kLag) != nullptr) return;
  register_algorithm<DeviceTimeEntry>({.info = {.name = kLag,
                                                .family = "test_lags",
                                                .summary = "arrival plus a constant",
                                                .source = "this test",
                                                .parameters = {{.name = "lag_ms",
                                                                .fallback = 1.0,
                                                                .low = 0,
                                                                .high = 100,
                                                                .choices = {},
                                                                .meaning = "the constant",
                                                                .source = "this test"}}},
                                       .make = [](const Parameters& parameters) {
                                         return std::make_unique<Lag>(parameters.number("lag_ms"));
                                       }});
}

Scenario lag_scenario() {
  register_lag();
  Scenario scenario = test_scenario();
  scenario.pipelines[0].device_time = kLag;
  return scenario;
}

std::string error_of(const Scenario& scenario, const std::vector<std::string>& names = {}) {
  try {
    choose_pipelines(scenario, names);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

double stamp_ms(const Scenario& scenario) {
  const PipelineChoice choice = choose_pipelines(scenario, {})[0];
  return to_ms(scorer_setup(scenario, choice).make_estimator(0)->stamp({}).time_since_epoch());
}

TEST(PipelineChoiceTest, ParametersComeFromFamilyThenName) {
  Scenario scenario = lag_scenario();
  EXPECT_DOUBLE_EQ(stamp_ms(scenario), 1);
  scenario.algorithms["test_lags"]["lag_ms"] = 2.0;
  EXPECT_DOUBLE_EQ(stamp_ms(scenario), 2);
  scenario.algorithms[kLag]["lag_ms"] = 3.0;
  EXPECT_DOUBLE_EQ(stamp_ms(scenario), 3);
}

TEST(PipelineChoiceTest, RefusesAValueThatIsNotAllowed) {
  Scenario scenario = lag_scenario();
  scenario.algorithms["test_lags"]["lag_ms"] = 101.0;
  EXPECT_THAT(error_of(scenario), HasSubstr("/algorithms/test_lags/lag_ms"));
  scenario.algorithms["test_lags"]["lag_ms"] = std::string("long");
  EXPECT_THAT(error_of(scenario), HasSubstr("/algorithms/test_lags/lag_ms"));
}

TEST(PipelineChoiceTest, RefusesAParameterThatIsNotDeclared) {
  Scenario scenario = lag_scenario();
  scenario.algorithms[kLag]["lag_us"] = 2.0;
  EXPECT_THAT(error_of(scenario),
              AllOf(HasSubstr("/algorithms/test_lag/lag_us"), HasSubstr("did you mean lag_ms")));
  scenario.algorithms.erase(kLag);
  scenario.algorithms["raw_arrival"]["lag_ms"] = 2.0;
  EXPECT_THAT(error_of(scenario),
              AllOf(HasSubstr("/algorithms/raw_arrival/lag_ms"), HasSubstr("no parameters")));
}

TEST(PipelineChoiceTest, RefusesParametersOfAnUnknownAlgorithm) {
  Scenario scenario = lag_scenario();
  scenario.algorithms["a/b~c"]["x"] = true;
  EXPECT_THAT(error_of(scenario), HasSubstr("/algorithms/a~1b~0c"));
}

TEST(PipelineChoiceTest, RefusesAlgorithmsThatNeedWhatTheWorldHasNot) {
  struct Case {
    const char* stage;
    const char* algorithm;
    const char* missing;
  };
  for (const Case& needy : {Case{"host_sync", "ptp_e2e_hardware", "/hosts/nic/hardware_stamps"},
                            Case{"host_sync", "pps", "/hosts/pulse_lines/pps"},
                            Case{"host_sync", "trigger_wired", "/hosts/pulse_lines/trigger"},
                            Case{"device_time", "host_stamps", "/cameras/stamp_clock"},
                            Case{"device_time", "rocsync_led", "/cameras/led_clock"},
                            Case{"device_time", "coded", "/trigger/code"},
                            Case{"device_time", "two_way_poll", "/cameras/clock_poll/interval_ms"},
                            Case{"device_time", "librealsense_global_steady", "clock_poll"}}) {
    Scenario scenario = test_scenario();
    scenarios::Pipeline& pipeline = scenario.pipelines[0];
    (needy.stage == std::string("host_sync") ? pipeline.host_sync : pipeline.device_time) =
        needy.algorithm;
    EXPECT_THAT(error_of(scenario),
                AllOf(HasSubstr(std::string("/pipelines/0/").append(needy.stage)),
                      HasSubstr("which needs"), HasSubstr(needy.missing)));
  }
}

TEST(PipelineChoiceTest, SuffixesOfADeviceTimeAreItsVariants) {
  Scenario scenario = test_scenario();
  scenario.pipelines[0].device_time = "hull_300_steady_calibrated";
  const PipelineChoice choice = choose_pipelines(scenario, {}).front();
  EXPECT_EQ(choice.device_time.info().name, "hull_300");
  EXPECT_TRUE(choice.device_time_variants.steady);
  EXPECT_TRUE(choice.device_time_variants.calibrated);
  scenario.pipelines[0].device_time = "oracle_steady";
  EXPECT_THAT(error_of(scenario), HasSubstr("has no variants"));
}

TEST(PipelineChoiceTest, NamesKnownAlgorithmsOfTheStage) {
  Scenario scenario = test_scenario();
  scenario.pipelines[1].device_time = "regresion_30";
  EXPECT_THAT(error_of(scenario),
              AllOf(HasSubstr("/pipelines/1/device_time"), HasSubstr("found \"regresion_30\""),
                    HasSubstr("did you mean regression_30"), HasSubstr("oracle")));
  scenario = test_scenario();
  scenario.pipelines[0].gathering = "oracel";
  EXPECT_THAT(error_of(scenario), AllOf(HasSubstr("/pipelines/0/gathering"), HasSubstr("genlock")));
  scenario = test_scenario();
  scenario.pipelines[0].host_sync = "ntpd";
  EXPECT_THAT(error_of(scenario),
              AllOf(HasSubstr("/pipelines/0/host_sync"), HasSubstr("ntp_last_set")));
  EXPECT_THROW(check_pipelines(scenario), InputError);
}

TEST(PipelineChoiceTest, NamesKnownPipelines) {
  EXPECT_THAT(error_of(test_scenario(), {"smoth"}),
              AllOf(HasSubstr("found \"smoth\""), HasSubstr("did you mean smooth"),
                    HasSubstr("arrival, smooth")));
  EXPECT_THAT(error_of(test_scenario(), {"smooth", "smooth"}), HasSubstr("twice"));
  EXPECT_EQ(error_of(test_scenario(), {"smooth"}), "no error");
}

TEST(PipelineChoiceTest, PublishedFiguresAreOfKnownMetrics) {
  const auto error_of_figure = [](const char* metric, double at_most) {
    Scenario scenario = test_scenario();
    scenario.published_figures = {{.pipeline = "arrival", .metric = metric, .at_most = at_most}};
    return error_of(scenario);
  };
  EXPECT_EQ(error_of_figure("amd_ms", 1), "no error");
  EXPECT_EQ(error_of_figure("bias_ms", -1), "no error");
  EXPECT_THAT(error_of_figure("exposure_spread_medain_ms", 1),
              AllOf(HasSubstr("/published_figures/0/metric: found \"exposure_spread_medain_ms\""),
                    HasSubstr("did you mean exposure_spread_median_ms")));
  EXPECT_THAT(
      error_of_figure("margin_ms", 1),
      AllOf(HasSubstr("/published_figures/0/metric: found \"margin_ms\", which has no value "
                      "of each seed, allowed: amd_ms, rmdv_ms"),
            Not(HasSubstr("emitted"))));
  EXPECT_THAT(error_of_figure("amd_ms", -1),
              HasSubstr("/published_figures/0/at_most: found -1, allowed a number from 0"));
  EXPECT_THAT(error_of_figure("seed_recall", 1.5),
              HasSubstr("/published_figures/0/at_most: found 1.5, allowed a share from 0 to 1"));
}

TEST(PipelineChoiceTest, TheOracleHasNoEstimator) {
  Scenario scenario = test_scenario();
  scenario.pipelines[0].device_time = "oracle";
  const ScorerSetup setup = scorer_setup(scenario, choose_pipelines(scenario, {})[0]);
  EXPECT_FALSE(setup.make_estimator);
}

TEST(PipelineChoiceTest, OnlyTheClaimsPipelineIsAlsoScoredOffline) {
  Scenario scenario = test_scenario();
  scenario.pipelines[1].name = "yoon2021_both";
  auto choices = choose_pipelines(scenario, {});
  EXPECT_FALSE(scorer_setup(scenario, choices[0]).make_second_estimator);
  EXPECT_TRUE(scorer_setup(scenario, choices[1]).make_second_estimator);
  scenario.cameras.count = 18'000;
  scenario.timeline.frames = 90;
  EXPECT_FALSE(scorer_setup(scenario, choices[1]).make_second_estimator);
}

TEST(PipelineChoiceTest, TheScenarioDecidesWhatIsScored) {
  Scenario scenario = test_scenario();
  scenario.evaluation.stream = scenarios::StreamKind::kColour;
  scenario.evaluation.rmdv_median = scenarios::MedianKind::kMeanOfMiddleTwo;
  scenario.evaluation.gathering_interval_periods = 0.25;
  EXPECT_EQ(scorer_setup(scenario, choose_pipelines(scenario, {})[0]).gathering_queue_frames,
            std::nullopt);
  scenario.evaluation.gathering_queue_frames = 17;
  scenario.cameras.sync_mode = scenarios::SyncMode::kGenlock;
  const ScorerSetup setup = scorer_setup(scenario, choose_pipelines(scenario, {})[0]);
  EXPECT_EQ(setup.stream, StreamKind::kColour);
  EXPECT_EQ(setup.median, MedianKind::kMeanOfMiddleTwo);
  EXPECT_DOUBLE_EQ(setup.gathering_interval_periods, 0.25);
  EXPECT_EQ(setup.gathering_queue_frames, 17U);
  EXPECT_TRUE(setup.genlock);
}

std::string problem_with(const std::vector<scenarios::Override>& overrides) {
  try {
    choose_pipelines(scenarios::load_scenario("18cam_6host_45fps_lan", overrides), {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(PipelineChoiceTest, ParametersThatContradictEachOtherAreRefusedWhereTheyAreSet) {
  EXPECT_EQ(problem_with({{"/algorithms/ntp/max_poll", "5"}}),
            "--set /algorithms/ntp/max_poll=5: parameter \"max_poll\" is 5; allowed: at least "
            "\"min_poll\", which is 6");
  EXPECT_THAT(problem_with({{"/algorithms/ntp/min_poll", "12"}}),
              HasSubstr("--set /algorithms/ntp/min_poll=12: parameter \"min_poll\" is 12"));
  EXPECT_THAT(problem_with({{"/algorithms/chrony/max_poll", "5"}}), HasSubstr("\"min_poll\""));
  EXPECT_THAT(problem_with({{"/algorithms/chrony/max_samples", "5"}}),
              HasSubstr("at least \"min_samples\", which is 6"));
  EXPECT_EQ(problem_with({{"/algorithms/ntp/max_poll", "5"}, {"/algorithms/ntp/min_poll", "4"}}),
            "none");
}

// Every pair of a least and a most is declared, whatever algorithm has it.
TEST(PipelineChoiceTest, EveryPairOfBoundsIsInOrder) {
  int pairs = 0;
  for (const HostSyncEntry& entry : nonempty(algorithms<HostSyncEntry>())) {
    for (const ParameterSpec& spec : entry.info.parameters) {
      if (!spec.name.starts_with("max_")) continue;
      const std::string least = "min_" + spec.name.substr(4);
      const bool has_least =
          std::any_of(entry.info.parameters.begin(), entry.info.parameters.end(),
                      [&](const ParameterSpec& other) { return other.name == least; });
      if (!has_least) continue;
      ++pairs;
      EXPECT_EQ(spec.not_below, least) << entry.info.name;
    }
  }
  EXPECT_GT(pairs, 3);
}

// A user's own algorithm that refuses what its declaration allows.
TEST(PipelineChoiceTest, AnAlgorithmThatCannotBeMadeIsRefused) {
  const char* const name = "test_fussy";
  if (find_algorithm<DeviceTimeEntry>(name) == nullptr) {
    register_algorithm<DeviceTimeEntry>({.info = {.name = name,
                                                  .family = name,
                                                  .summary = "takes no odd number",
                                                  .source = "this test",
                                                  .parameters = {{.name = "number",
                                                                  .fallback = 2,
                                                                  .low = 0,
                                                                  .high = 9,
                                                                  .choices = {},
                                                                  .meaning = "",
                                                                  .source = "test"}}},
                                         .make = [](const Parameters& parameters) {
                                           if (parameters.number("number") == 3) {
                                             throw ParameterError("number",
                                                                  "found 3, allowed: even numbers");
                                           }
                                           return std::make_unique<Lag>(1);
                                         }});
  }
  const std::vector<scenarios::Override> base = {{"/pipelines/0/device_time", name}};
  EXPECT_EQ(problem_with(base), "none");
  std::vector<scenarios::Override> odd = base;
  odd.push_back({"/algorithms/test_fussy/number", "3"});
  EXPECT_EQ(problem_with(odd),
            "--set /algorithms/test_fussy/number=3: found 3, allowed: even numbers");
}

// Programs that are not there: no capture can be made, but one that was recorded is played.
TEST(PipelineChoice, ARecordingNeedsNoPrograms) {
  class TestRun final : public RecordingSource {
   public:
    explicit TestRun(bool runs) : runs_(runs) {}
    RecordingCost record(const RecordingRequest& request, RecordingSink& sink) override {
      return TestSource().record(request, sink);
    }
    bool runs_host_sync() const override { return runs_; }

   private:
    bool runs_;
  };
  PipelineChoice choice = choose_pipelines(test_scenario(), {"arrival"}).front();
  choice.problem = "ntpd is not there";
  KeptRecording kept;
  TestRun world(true), recording(false);
  EXPECT_THROW(record_run(world, choice, 1, kept), RecordingFailed);
  EXPECT_NO_THROW(record_run(recording, choice, 1, kept));
}

}  // namespace
}  // namespace simbench::evaluation
