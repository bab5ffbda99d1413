#include "evaluation/run/run_detail.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

RunDetail detail(const scenarios::Scenario& scenario, const std::string& pipeline,
                 std::uint64_t seed = 1) {
  const auto source = sim::make_simulation(scenario);
  return run_detail(scenario, choose_pipelines(scenario, {pipeline}).front(), seed, *source);
}

scenarios::Scenario short_scenario(std::vector<scenarios::Override> more = {}) {
  more.push_back({"/timeline/frames", "60"});
  return scenarios::load_scenario("18cam_6host_45fps", more);
}

TEST(RunDetailTest, IsTheRunThatIsEvaluated) {
  const scenarios::Scenario scenario = short_scenario();
  for (const std::string pipeline : {"yoon2021_both", "ntp_w32time", "genlock"}) {
    const Results results = evaluate(
        scenario, [&] { return sim::make_simulation(scenario); },
        {.first_seed = 3, .seeds = 1, .jobs = 1, .pipelines = {pipeline}}, nullptr);
    const RunDetail run = detail(scenario, pipeline, 3);
    EXPECT_EQ(run.score.amd_ms, results.rows.front().amd_ms.values.front()) << pipeline;
    EXPECT_EQ(run.score.absolute_error_ms, results.rows.front().absolute_error_ms.values.front());
    EXPECT_EQ(run.score.cost.trace_hash, results.rows.front().seeds.front().cost.trace_hash);
  }
}

TEST(RunDetailTest, GlobalStampsAndReferencesGiveTheScoresAgain) {
  for (const std::string pipeline : {"yoon2021_both", "genlock"}) {
    const RunDetail run = detail(short_scenario(), pipeline);
    double sum = 0;
    double count = 0;
    for (const CameraDetail& camera : run.cameras) {
      for (const FrameDetail& frame : camera.frames) {
        if (!frame.evaluated) continue;
        sum += std::abs(frame.global_ms - frame.reference_ms);
        ++count;
      }
    }
    EXPECT_EQ(count, 18 * 60);
    EXPECT_NEAR(sum / count, run.score.absolute_error_ms, 1e-9) << pipeline;
  }
}

TEST(RunDetailTest, TheWarmUpIsThereAndHasNoGlobalStamps) {
  const RunDetail run = detail(short_scenario(), "yoon2021_both");
  const std::vector<FrameDetail>& frames = run.cameras.front().frames;
  ASSERT_EQ(frames.size(), 225U + 60U);
  EXPECT_TRUE(frames.front().in_warm_up);
  EXPECT_TRUE(std::isnan(frames.front().global_ms));
  EXPECT_FALSE(std::isnan(frames.front().from_start_ms));
  EXPECT_FALSE(frames.back().in_warm_up);
  EXPECT_NEAR(run.evaluated_start_ms - run.capture_start_ms, 5000, 30);
}

TEST(RunDetailTest, OnlineIsThePipelineItselfWhereThatIsTheRegression) {
  const RunDetail run = detail(short_scenario(), "yoon2021_both");
  int frames = 0;
  for (const FrameDetail& frame : run.cameras.at(7).frames) {
    if (frame.in_warm_up) continue;
    ++frames;
    EXPECT_EQ(frame.online_ms, frame.global_ms);
    EXPECT_NEAR(frame.offline_ms, frame.online_ms, 2);
  }
  EXPECT_EQ(frames, 60);
}

TEST(RunDetailTest, OracleClocksAreAlwaysRightAndUnsynchronisedOnesKeepTheirOffset) {
  const RunDetail oracle = detail(short_scenario(), "oracle");
  ASSERT_FALSE(oracle.clocks.empty());
  for (const ClockErrors& clocks : oracle.clocks) {
    for (const double error : clocks.errors_ms) EXPECT_EQ(error, 0);
  }
  const RunDetail free =
      detail(short_scenario({{"/hosts/clock/oscillator/skew_sigma_ppm", "0"},
                             {"/hosts/clock/oscillator/random_walk_ppb_per_sqrt_s", "0"},
                             {"/hosts/clock/oscillator/white_frequency_ppb", "0"}}),
             "free_running");
  ASSERT_GT(free.clocks.size(), 10U);
  for (std::size_t host = 1; host < nonempty(free.clocks.front().errors_ms).size(); ++host) {
    const double initial = free.clocks.front().errors_ms[host];
    EXPECT_GT(std::abs(initial), 0.001);
    EXPECT_NEAR(free.clocks.back().errors_ms[host], initial, 1e-3);
  }
}

TEST(RunDetailTest, SynchronisationEndsAPauseBeforeTheCapture) {
  const RunDetail run = detail(short_scenario(), "yoon2021_both");
  EXPECT_EQ(run.world_start_ms, 0);
  EXPECT_GT(run.sync_end_ms, 0);
  EXPECT_EQ(run.capture_start_ms, run.sync_end_ms + 12000);
  EXPECT_FALSE(run.service);
  EXPECT_GE(run.clocks.back().at_ms, run.evaluated_start_ms);
}

TEST(RunDetailTest, EveryFrameIsDeliveredOrLost) {
  const RunDetail run = detail(short_scenario({{"/cameras/drop_probability", "0.1"}}), "oracle");
  EXPECT_GT(run.lost.size(), 100U);
  std::int64_t lost_of_evaluated = 0;
  for (const LostFrame& lost : run.lost) {
    EXPECT_EQ(lost.fate, FrameFate::kLostInCamera);
    for (const FrameDetail& frame : nonempty(run.cameras.at(lost.camera).frames)) {
      EXPECT_NE(frame.counter, lost.counter);
    }
    if (lost.pulse >= run.first_pulse && lost.pulse < run.first_pulse + run.pulses) {
      ++lost_of_evaluated;
    }
  }
  EXPECT_EQ(lost_of_evaluated, run.score.frames.dropped);
}

TEST(RunDetailTest, SetsAreThoseThatAreCounted) {
  const RunDetail run = detail(short_scenario({{"/cameras/drop_probability", "0.02"}}), "oracle");
  std::int64_t complete = 0;
  std::int64_t pure = 0;
  for (const SetDetail& set : nonempty(run.sets)) {
    complete += set.complete ? 1 : 0;
    pure += set.complete && set.pure ? 1 : 0;
    if (!set.complete) continue;
    EXPECT_EQ(set.members.size(), 18U);
    for (const SetDetail::Member& member : set.members) {
      const FrameDetail& frame = run.cameras.at(member.camera).frames.at(member.frame);
      if (set.pure) {
        EXPECT_EQ(frame.pulse, set.pulse);
      }
    }
  }
  EXPECT_GT(pure, 0);
  EXPECT_EQ(complete, run.score.sets.emitted);
  EXPECT_EQ(pure, run.score.sets.pure);
}

TEST(RunDetailTest, KeepsTheFirstCamerasOfMany) {
  const scenarios::Scenario scenario =
      short_scenario({{"/hosts/count", "8"}, {"/cameras/count", "24"}});
  const RunDetail run = detail(scenario, "oracle");
  EXPECT_EQ(run.camera_count, 24U);
  EXPECT_EQ(run.cameras.size(), kDetailCameras);
  EXPECT_EQ(run.score.frames.expected, 24 * 60);
  ASSERT_FALSE(run.sets.empty());
  EXPECT_EQ(run.sets.front().members.size(), kDetailCameras);
  EXPECT_TRUE(run.sets.front().complete);
}

}  // namespace
}  // namespace simbench::evaluation
