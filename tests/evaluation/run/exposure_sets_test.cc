#include "evaluation/run/exposure_sets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/evaluation/test_capture.h"
#include "tests/evaluation/test_scenario.h"

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kRoundingMs = 1e-6;

// A backend that plays one hand-made capture.
class Played final : public RecordingSource {
 public:
  explicit Played(TestCapture capture) : capture_(std::move(capture)) {}
  RecordingCost record(const RecordingRequest&, RecordingSink& sink) override {
    capture_.record(sink);
    return {.events = 7};
  }

 private:
  TestCapture capture_;
};

// Sets by bare arrivals: pulses 3 to 12 are evaluated, one each 20 ms.
ExposureSets sets_of(const TestCapture& capture, std::size_t count = 10) {
  const scenarios::Scenario scenario = test_scenario();
  Played source(capture);
  return exposure_sets(scenario, choose_pipelines(scenario, {"arrival"}).front(), 1, source, count);
}

std::vector<std::uint32_t> counters_of(const ExposureSets& sets, std::size_t camera) {
  std::vector<std::uint32_t> counters;
  for (const ExposureSet& set : sets.sets) {
    if (set.cameras.at(camera)) counters.push_back(set.cameras[camera]->counter);
  }
  return counters;
}

std::int64_t missing_in(const ExposureSets& sets) {
  std::int64_t missing = 0;
  for (const ExposureSet& set : sets.sets) {
    missing += std::count(set.cameras.begin(), set.cameras.end(), std::nullopt);
  }
  return missing;
}

double mean_spread_ms(const ExposureSets& sets) {
  double sum = 0;
  for (const ExposureSet& set : sets.sets) sum += set.spread_ms();
  return sum / static_cast<double>(sets.sets.size());
}

TEST(ExposureSet, Spread) {
  ExposureSet set;
  EXPECT_EQ(set.spread_ms(), 0);
  set.cameras = {std::nullopt, SetExposure{.mid_exposure_s = 5}};
  EXPECT_EQ(set.spread_ms(), 0);
  set.cameras.emplace_back(SetExposure{.mid_exposure_s = 4.25});
  set.cameras.emplace_back(SetExposure{.mid_exposure_s = 4.5});
  EXPECT_EQ(set.spread_ms(), 750);
}

TEST(ExposureSets, EqualClocksGiveTheSpreadOfTheExposures) {
  TestCapture capture(2, 2);
  capture.exposed_late_by = [](std::uint32_t camera, std::int64_t) { return from_ms(camera); };
  const ExposureSets sets = sets_of(capture);
  ASSERT_EQ(sets.sets.size(), 9U) << "at the first pulse, camera 3 had no stamp yet";
  for (std::size_t i = 0; i < sets.sets.size(); ++i) {
    const ExposureSet& set = sets.sets[i];
    ASSERT_EQ(set.cameras.size(), 4U);
    EXPECT_NEAR(set.spread_ms(), 3, kRoundingMs);
    for (std::size_t camera = 0; camera < 4; ++camera) {
      ASSERT_TRUE(set.cameras[camera].has_value());
      EXPECT_EQ(set.cameras[camera]->counter, 4 + i);
      EXPECT_NEAR(set.cameras[camera]->mid_exposure_s,
                  0.02 * static_cast<double>(i + 1) + 0.001 * static_cast<double>(camera), 1e-9);
    }
  }
  EXPECT_EQ(sets.gathered_sets, 10);
  EXPECT_EQ(sets.score.seed, 1U);
  EXPECT_EQ(sets.score.cost.events, 7U);
}

// Host 1 is ahead by three frames: what it stamps like pulse p was exposed by pulse p - 3.
TEST(ExposureSets, ClocksOffByWholeFrames) {
  TestCapture capture(2, 2);
  capture.host_errors = {Nanoseconds(0), 3 * TestCapture::kPeriod};
  const ExposureSets sets = sets_of(capture, 7);
  EXPECT_THAT(counters_of(sets, 0), ElementsAre(6, 7, 8, 9, 10, 11, 12)) << "where stamps overlap";
  EXPECT_THAT(counters_of(sets, 1), ElementsAre(6, 7, 8, 9, 10, 11, 12));
  EXPECT_THAT(counters_of(sets, 3), ElementsAre(3, 4, 5, 6, 7, 8, 9));
  for (const ExposureSet& set : sets.sets) EXPECT_NEAR(set.spread_ms(), 60, kRoundingMs);
}

// A clock that is off by less than half a frame changes no set, by more than half takes the
// neighbour.
TEST(ExposureSets, TheNearestStampDecides) {
  for (const auto& [error_ms, spread_ms] :
       {std::pair(9.0, 0.0), std::pair(11.0, 20.0), std::pair(-9.0, 0.0), std::pair(-31.0, 40.0)}) {
    TestCapture capture(2, 1);
    capture.host_errors = {Nanoseconds(0), from_ms(error_ms)};
    const ExposureSets sets = sets_of(capture, 3);
    ASSERT_EQ(sets.sets.size(), 3U);
    EXPECT_EQ(missing_in(sets), 0);
    EXPECT_NEAR(mean_spread_ms(sets), spread_ms, kRoundingMs) << error_ms;
  }
}

TEST(ExposureSets, WithoutAnyOverlapAllPulsesAreAnchors) {
  TestCapture capture(2, 2);
  capture.host_errors = {Nanoseconds(0), 100 * TestCapture::kPeriod};
  const ExposureSets sets = sets_of(capture);
  EXPECT_THAT(counters_of(sets, 0), ElementsAre(3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
  EXPECT_EQ(missing_in(sets), 20);
  EXPECT_EQ(mean_spread_ms(sets), 0);
}

TEST(ExposureSets, AnchorsAreSpreadEvenly) {
  const TestCapture capture(2, 2);
  EXPECT_THAT(counters_of(sets_of(capture, 1), 0), ElementsAre(8));
  EXPECT_THAT(counters_of(sets_of(capture, 2), 0), ElementsAre(5, 10));
  EXPECT_THAT(counters_of(sets_of(capture, 5), 0), ElementsAre(4, 6, 8, 10, 12));
  EXPECT_EQ(sets_of(capture, 0).sets.size(), 0U);
  EXPECT_EQ(sets_of(capture, 1000).sets.size(), 10U) << "a pulse is an anchor once";
}

TEST(ExposureSets, ACameraThatIsAwayIsMissing) {
  TestCapture capture(2, 2);
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
    return camera == 2 && pulse >= 6 && pulse < 10;
  };
  const ExposureSets sets = sets_of(capture);
  EXPECT_THAT(counters_of(sets, 2), ElementsAre(3, 4, 5, 10, 11, 12));
  EXPECT_EQ(missing_in(sets), 4);
  EXPECT_EQ(sets.gathered_sets, 6);
}

// Not even one lost frame is made up for by its neighbour.
TEST(ExposureSets, OneLostFrame) {
  TestCapture capture(2, 2);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(camera == 1 && pulse == 8 ? -3 : 0);
  };
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) { return camera == 1 && pulse == 7; };
  EXPECT_THAT(counters_of(sets_of(capture), 1), ElementsAre(3, 4, 5, 6, 8, 9, 10, 11, 12));
}

TEST(ExposureSets, ACameraThatNeverCame) {
  TestCapture capture(2, 2);
  capture.lost = [](std::uint32_t camera, std::int64_t) { return camera == 3; };
  EXPECT_EQ(missing_in(sets_of(capture)), 10);
  // The master's second camera is the anchor then.
  capture.lost = [](std::uint32_t camera, std::int64_t) { return camera == 0; };
  const ExposureSets sets = sets_of(capture, 2);
  EXPECT_THAT(counters_of(sets, 1), ElementsAre(5, 10));
  EXPECT_EQ(missing_in(sets), 2);
  // And if the master has none at all, another host's.
  capture.lost = [](std::uint32_t camera, std::int64_t) { return camera < 2; };
  EXPECT_THAT(counters_of(sets_of(capture, 2), 2), ElementsAre(5, 10));
  capture.lost = [](std::uint32_t, std::int64_t) { return true; };
  EXPECT_TRUE(sets_of(capture).sets.empty());
}

// Four hosts a quarter of a period apart: no four stamps fit into half a period.
TEST(ExposureSets, SetsWhereAlgorithm3GivesNone) {
  TestCapture capture(4, 1);
  capture.host_errors = {from_ms(0), from_ms(5), from_ms(9), from_ms(14)};
  const ExposureSets sets = sets_of(capture, 4);
  EXPECT_EQ(sets.gathered_sets, 0);
  EXPECT_EQ(sets.sets.size(), 4U);
  EXPECT_EQ(missing_in(sets), 0);
  EXPECT_NEAR(mean_spread_ms(sets), 20, kRoundingMs)
      << "the last host's nearest is a pulse earlier";
}

TEST(ExposureSets, NeedTheTruth) {
  TestCapture capture(2, 2);
  capture.with_truth = false;
  try {
    sets_of(capture);
    ADD_FAILURE() << "no error";
  } catch (const RecordingFailed& error) {
    EXPECT_THAT(error.what(), HasSubstr("only a simulation has them"));
  }
}

scenarios::Scenario studio(std::vector<scenarios::Override> more = {}) {
  more.push_back({"/timeline/frames", "90"});
  return scenarios::load_scenario("18cam_6host_30fps_studio", more);
}

ExposureSets simulated_sets(const scenarios::Scenario& scenario, const std::string& pipeline,
                            std::uint64_t seed = 1) {
  const auto source = sim::make_simulation(scenario);
  return exposure_sets(scenario, choose_pipelines(scenario, {pipeline}).front(), seed, *source, 10);
}

constexpr double kPulsePeriodMs = 1e3 / 30;

TEST(ExposureSetsSimulated, SynchronisedHostsGroupWhatThePulseExposed) {
  const scenarios::Scenario scenario = studio();
  for (const std::string pipeline : {"oracle", "two_way_hull", "yoon2021_both"}) {
    const ExposureSets sets = simulated_sets(scenario, pipeline);
    ASSERT_EQ(sets.sets.size(), 10U) << pipeline;
    EXPECT_EQ(missing_in(sets), 0) << pipeline;
    // Hosts expose by up to 0.14 periods longer: half of that at mid-exposure.
    EXPECT_LT(mean_spread_ms(sets), 0.07 * kPulsePeriodMs) << pipeline;
    EXPECT_NEAR(mean_spread_ms(sets), sets.score.exposure_spread_ms, 1e-3) << pipeline;
    EXPECT_EQ(sets.gathered_sets, 90) << pipeline;
  }
}

TEST(ExposureSetsSimulated, UnsynchronisedHostsAreAsFarApartAsTheirClocks) {
  const scenarios::Scenario scenario = studio();
  int without_sets = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ExposureSets sets = simulated_sets(scenario, "ntp_last_set", seed);
    ASSERT_EQ(sets.sets.size(), 10U);
    EXPECT_EQ(missing_in(sets), 0);
    const auto [least, most] =
        std::minmax_element(sets.score.host_errors_ms.begin(), sets.score.host_errors_ms.end());
    const double disagreement_ms = *most - *least;
    EXPECT_GT(disagreement_ms, 4 * kPulsePeriodMs) << "seed " << seed;
    // Each end of the range is off by half a period at most, and by the exposures' differences.
    EXPECT_NEAR(mean_spread_ms(sets), disagreement_ms, 1.2 * kPulsePeriodMs) << "seed " << seed;
    without_sets += sets.gathered_sets == 0 ? 1 : 0;
  }
  EXPECT_GT(without_sets, 0) << "Algorithm 3 gives none in most seeds";
}

TEST(ExposureSetsSimulated, OfflineAndRelativeEstimators) {
  scenarios::Scenario scenario = studio();
  scenario.pipelines[1].device_time = "regression_offline";
  const ExposureSets offline = simulated_sets(scenario, "yoon2021_both");
  EXPECT_EQ(missing_in(offline), 0);
  EXPECT_NEAR(mean_spread_ms(offline), offline.score.exposure_spread_ms, 1e-3);

  const scenarios::Scenario genlock = scenarios::load_scenario(
      "18cam_6host_45fps", {{"/timeline/frames", "60"}, {"/cameras/exposure_host_periods", "0"}});
  const ExposureSets relative = simulated_sets(genlock, "genlock");
  ASSERT_EQ(relative.sets.size(), 10U);
  EXPECT_EQ(missing_in(relative), 0);
  EXPECT_NEAR(mean_spread_ms(relative), 0, kRoundingMs);
}

TEST(ExposureSetsSimulated, FreeRunningCamerasAddTheirPhase) {
  const ExposureSets sets = simulated_sets(studio({{"/cameras/sync_mode", "default"}}), "oracle");
  ASSERT_EQ(sets.sets.size(), 10U);
  EXPECT_EQ(missing_in(sets), 0);
  for (const ExposureSet& set : sets.sets) {
    EXPECT_GT(set.spread_ms(), 0.4 * kPulsePeriodMs) << "18 phases at random";
    EXPECT_LT(set.spread_ms(), 1.01 * kPulsePeriodMs);
  }
}

TEST(ExposureSetsSimulated, AVanishedCamera) {
  const ExposureSets sets =
      simulated_sets(studio({{"/faults", R"([{"kind": "camera_vanishes", "camera": 4, "at_ms": 6000,
                               "duration_ms": 1500}])"}}),
                     "oracle");
  ASSERT_EQ(sets.sets.size(), 10U);
  const std::size_t seen = counters_of(sets, 4).size();
  EXPECT_GT(seen, 2U);
  EXPECT_LT(seen, 8U);
  EXPECT_EQ(missing_in(sets), static_cast<std::int64_t>(10 - seen));
}

TEST(ExposureSetsSimulated, IsTheRunThatIsEvaluatedEveryTime) {
  const scenarios::Scenario scenario = studio();
  const Results results = evaluate(
      scenario, [&] { return sim::make_simulation(scenario); },
      {.first_seed = 3, .seeds = 1, .jobs = 1, .pipelines = {"yoon2021_both"}}, nullptr);
  const ExposureSets once = simulated_sets(scenario, "yoon2021_both", 3);
  const ExposureSets again = simulated_sets(scenario, "yoon2021_both", 3);
  EXPECT_EQ(once.score.amd_ms, results.rows.front().amd_ms.values.front());
  EXPECT_EQ(once.score.cost.trace_hash, results.rows.front().seeds.front().cost.trace_hash);
  ASSERT_EQ(once.sets.size(), again.sets.size());
  for (std::size_t i = 0; i < once.sets.size(); ++i) {
    for (std::size_t camera = 0; camera < 18; ++camera) {
      EXPECT_EQ(once.sets[i].cameras[camera]->mid_exposure_s,
                again.sets[i].cameras[camera]->mid_exposure_s);
    }
  }
}

}  // namespace
}  // namespace simbench::evaluation
