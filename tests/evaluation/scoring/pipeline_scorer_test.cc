#include "evaluation/scoring/pipeline_scorer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/device_time/yoon2021.h"
#include "tests/evaluation/test_capture.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::IsNan;

TEST(PipelineScorerTest, PerfectStampsScoreZero) {
  const SeedScore seed = score(TestCapture(2, 3), arrival_setup());
  EXPECT_DOUBLE_EQ(seed.amd_ms, 0);
  EXPECT_DOUBLE_EQ(seed.rmdv_ms, 0);
  EXPECT_DOUBLE_EQ(seed.exposure_spread_ms, 0);
  EXPECT_DOUBLE_EQ(seed.absolute_error_ms, 10);  // a bare arrival is late by the latency
  EXPECT_DOUBLE_EQ(seed.bias_ms, 10);
  EXPECT_DOUBLE_EQ(seed.host_error_ms, 0);
  EXPECT_DOUBLE_EQ(seed.share_below_half_period, 1);
  EXPECT_EQ(seed.frames.expected, 60);
  EXPECT_EQ(seed.frames.delivered, 60);
  EXPECT_EQ(seed.frames.dropped, 0);
  EXPECT_EQ(seed.sets.emitted, 10);
  EXPECT_EQ(seed.sets.pure, 10);
  EXPECT_EQ(seed.sets.complete_pulses, 10);
  EXPECT_THAT(seed.offline_amd_ms, IsNan());
}

// One camera of six is late: by 6 ms in odd pulses, whose mean is 1 ms above the median, and early
// by as much in even ones, which have no real root.
TEST(PipelineScorerTest, RmdvAsPrintedIsOverThePulsesThatHaveARoot) {
  TestCapture capture(2, 3);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(camera != 4 ? 6 : pulse % 2 == 1 ? 12 : 0);
  };
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_NEAR(seed.rmdv_printed_sqrt_ms, 1, kTolerance);
  EXPECT_DOUBLE_EQ(seed.rmdv_printed_share, 0.5);
  EXPECT_NEAR(seed.rmdv_ms, std::sqrt(6.0), kTolerance);
}

// A mode too slow for the pulses: each camera exposes at every second one. Pulses 3 to 12 count.
TEST(PipelineScorerTest, PulsesThatNeverExposeAreNoLostFrames) {
  ScorerSetup setup = arrival_setup();
  setup.pulses_per_frame = 2;
  TestCapture capture(2, 3);
  capture.late_by = staircase;
  capture.lost = [](std::uint32_t, std::int64_t pulse) { return pulse % 2 == 1; };
  const SeedScore even = score(capture, setup);
  EXPECT_EQ(even.frames.expected, 6 * 5);
  EXPECT_EQ(even.frames.delivered, 6 * 5);
  EXPECT_EQ(even.frames.dropped, 0);
  EXPECT_EQ(even.sets.complete_pulses, 5);
  ASSERT_EQ(even.pulses.size(), 5U);
  EXPECT_EQ(even.pulses.front().pulse, 4);
  EXPECT_NEAR(even.amd_ms, 5, kTolerance) << "over the pulses that expose";

  capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
    return pulse % 2 == 1 || (camera == 1 && (pulse == 4 || pulse == 8 || pulse == 12)) ||
           camera == 5;
  };
  const SeedScore lossy = score(capture, setup);
  EXPECT_EQ(lossy.frames.expected, 6 * 5);
  EXPECT_EQ(lossy.frames.delivered, 4 * 5 + 2);
  EXPECT_EQ(lossy.frames.dropped, 3 + 5);

  // Camera 0 exposes at the odd pulses 3, 5, 7, 9 and 11: no pulse is complete.
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
    return pulse % 2 == (camera == 0 ? 0 : 1);
  };
  const SeedScore apart = score(capture, setup);
  EXPECT_EQ(apart.frames.dropped, 0);
  EXPECT_EQ(apart.frames.expected, 6 * 5);
  EXPECT_EQ(apart.sets.complete_pulses, 0);
  EXPECT_THAT(apart.amd_ms, IsNan());
}

TEST(PipelineScorerTest, AmdAndRmdvOfAStaircase) {
  TestCapture capture(2, 3);
  capture.late_by = staircase;
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_NEAR(seed.amd_ms, 5, kTolerance);
  EXPECT_NEAR(seed.rmdv_ms, std::sqrt((9.0 + 4 + 1 + 0 + 1 + 4) / 6), kTolerance);  // about 3
  EXPECT_TRUE(std::isnan(seed.rmdv_printed_sqrt_ms));  // the mean, 2.5, is below 3
  EXPECT_DOUBLE_EQ(seed.rmdv_printed_share, 0);
  EXPECT_NEAR(seed.absolute_error_ms, 12.5, kTolerance);
  EXPECT_NEAR(seed.spread_in_host_ms, 2, kTolerance);
  EXPECT_NEAR(seed.spread_between_hosts_ms, 3, kTolerance);
  EXPECT_NEAR(seed.trend_ms, 0, kTolerance);
  ASSERT_EQ(seed.pulses.size(), 10U);
  EXPECT_EQ(seed.pulses.front().pulse, 3);
  EXPECT_EQ(seed.pulses.back().pulse, 12);
  EXPECT_NEAR(seed.pulses.front().spread_ms, 5, kTolerance);
}

TEST(PipelineScorerTest, RmdvWithTheMeanOfTheMiddleTwo) {
  TestCapture capture(2, 3);
  capture.late_by = staircase;
  ScorerSetup setup = arrival_setup();
  setup.median = MedianKind::kMeanOfMiddleTwo;
  EXPECT_NEAR(score(capture, setup).rmdv_ms, std::sqrt(2 * (6.25 + 2.25 + 0.25) / 6), kTolerance);
}

TEST(PipelineScorerTest, OnlyPulsesThatAllCamerasDeliveredCount) {
  TestCapture capture(1, 3);
  // Pulse 5 would raise AMD, but camera 0 lost it.
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(pulse == 5 ? 4.0 * camera : 1.0 * camera);
  };
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
    return camera == 0 && (pulse == 5 || pulse == 1);
  };
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_NEAR(seed.amd_ms, 2, kTolerance);
  EXPECT_EQ(seed.sets.complete_pulses, 9);
  EXPECT_EQ(seed.frames.expected, 30);
  EXPECT_EQ(seed.frames.delivered, 29);
  EXPECT_EQ(seed.frames.dropped, 1);
  EXPECT_EQ(seed.sets.emitted, 9);
  EXPECT_EQ(seed.sets.pure, 9);
  EXPECT_EQ(seed.sets.discarded_frames, 2);
  EXPECT_NEAR(seed.absolute_error_ms, 11, kTolerance);
}

TEST(PipelineScorerTest, TheWarmUpIsNotScored) {
  TestCapture capture(1, 2);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(pulse < 3 ? 8.0 * camera : 1.0 * camera);
  };
  EXPECT_NEAR(score(capture, arrival_setup()).amd_ms, 1, kTolerance);
}

// Remembers what it was given; its stamps are the arrivals.
class SpyEstimator final : public DeviceTimeEstimator {
 public:
  explicit SpyEstimator(std::vector<DeviceSample>& seen, bool relative)
      : seen_(seen), relative_(relative) {}
  GlobalTime stamp(const DeviceSample& sample) override {
    seen_.push_back(sample);
    return GlobalTime(sample.arrival.time_since_epoch());
  }
  bool relative() const override { return relative_; }

 private:
  std::vector<DeviceSample>& seen_;
  bool relative_;
};

TEST(PipelineScorerTest, EstimatorsBeginAfterTheWarmUpUnlessRelative) {
  for (const bool relative : {false, true}) {
    std::vector<DeviceSample> seen;
    ScorerSetup setup = arrival_setup();
    setup.make_estimator = [&](std::size_t) {
      return std::make_unique<SpyEstimator>(seen, relative);
    };
    score(TestCapture(1, 1), setup);
    EXPECT_EQ(seen.size(), relative ? 13U : 10U);
    const std::int64_t first_pulse = relative ? 0 : 3;
    EXPECT_EQ(nanoseconds_of(seen.front().sensor), nanoseconds_of(TestCapture::at(first_pulse)));
  }
}

TEST(PipelineScorerTest, UnwrapsTheDeviceClock) {
  std::vector<DeviceSample> seen;
  ScorerSetup setup = arrival_setup();
  setup.make_estimator = [&](std::size_t) { return std::make_unique<SpyEstimator>(seen, false); };
  TestCapture capture(1, 1);
  // The register wraps between pulses 5 and 6.
  const std::int64_t wrap_ns = (std::int64_t{1} << 32) * 1000;
  capture.sensor_late_by = [&](std::uint32_t, std::int64_t) {
    return Nanoseconds(wrap_ns - nanoseconds_of(TestCapture::at(6)));
  };
  score(capture, setup);
  ASSERT_EQ(seen.size(), 10U);
  for (std::size_t i = 1; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].sensor - seen[i - 1].sensor, Microseconds(20'000));
  }
}

TEST(PipelineScorerTest, OtherStreamsAreNotScored) {
  // The same frames as colour, in a capture that is scored by depth.
  TestCapture capture(1, 2);
  ScorerSetup setup = arrival_setup();
  setup.stream = StreamKind::kColour;
  const SeedScore seed = score(capture, setup);
  EXPECT_EQ(seed.frames.delivered, 0);
  EXPECT_THAT(seed.amd_ms, IsNan());
}

TEST(PipelineScorerTest, OracleStampsAreTheOwnHostsTrueTime) {
  TestCapture capture(3, 1);
  capture.late_by = staircase;
  capture.host_errors = {Nanoseconds(0), from_ms(-1), from_ms(3)};
  capture.exposed_late_by = [](std::uint32_t camera, std::int64_t) {
    return from_ms(camera == 1 ? 2 : 0);
  };
  ScorerSetup setup = arrival_setup();
  setup.make_estimator = nullptr;
  const SeedScore seed = score(capture, setup);
  EXPECT_NEAR(seed.exposure_spread_ms, 2, kTolerance);
  EXPECT_NEAR(seed.amd_ms, 3, kTolerance);  // 0, 2 - 1, 3
  EXPECT_NEAR(seed.absolute_error_ms, 4.0 / 3, kTolerance);
  EXPECT_NEAR(seed.bias_ms, 2.0 / 3, kTolerance);
  EXPECT_NEAR(seed.host_error_ms, 2, kTolerance);
  EXPECT_THAT(seed.host_errors_ms, ElementsAre(0, -1, 3));
}

TEST(PipelineScorerTest, OracleNeedsTruth) {
  TestCapture capture(1, 1);
  capture.with_truth = false;
  ScorerSetup setup = arrival_setup();
  setup.make_estimator = nullptr;
  setup.genlock = true;
  EXPECT_THROW(score(capture, setup), RecordingFailed);
}

TEST(PipelineScorerTest, FreeRunningFramesArePartOfTheStreamButNotScored) {
  std::vector<DeviceSample> seen;
  ScorerSetup setup = arrival_setup();
  setup.make_estimator = [&](std::size_t) { return std::make_unique<SpyEstimator>(seen, false); };
  PipelineScorer scorer(setup);
  TestCapture capture(1, 1);
  scorer.on_start(capture.layout);
  FrameTruth free_running;
  free_running.pulse = -1;
  scorer.on_frame({}, &free_running);  // in the warm-up
  capture.deliver(0, 3, scorer);
  scorer.on_frame({}, &free_running);
  capture.deliver(0, 5, scorer);
  const SeedScore seed = scorer.finish();
  EXPECT_EQ(seen.size(), 3U);
  EXPECT_EQ(seed.frames.delivered, 2);
}

TEST(PipelineScorerTest, OneHostHasNoHostErrorAndNoSpreadBetweenHosts) {
  const SeedScore one_host = score(TestCapture(1, 3), arrival_setup());
  EXPECT_THAT(one_host.host_error_ms, IsNan());
  EXPECT_THAT(one_host.spread_between_hosts_ms, IsNan());
  const SeedScore one_camera_each = score(TestCapture(3, 1), arrival_setup());
  EXPECT_THAT(one_camera_each.spread_in_host_ms, IsNan());
}

TEST(PipelineScorerTest, OneCameraHasNoRange) {
  const SeedScore seed = score(TestCapture(1, 1), arrival_setup());
  for (const double value : {seed.amd_ms, seed.rmdv_ms, seed.set_amd_ms, seed.exposure_spread_ms,
                             seed.trend_ms, seed.share_below_half_period}) {
    EXPECT_THAT(value, IsNan());
  }
  EXPECT_FALSE(std::isnan(seed.absolute_error_ms));
  EXPECT_GT(seed.sets.complete_pulses, 0);
  for (const PulseScore& pulse : nonempty(seed.pulses)) {
    EXPECT_THAT(pulse.spread_ms, IsNan());
    EXPECT_THAT(pulse.deviation_ms, IsNan());
  }
}

TEST(PipelineScorerTest, TrendIsTheChangeFromFirstToLast) {
  TestCapture capture(1, 2);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(camera == 1 ? 1 + 0.5 * static_cast<double>(pulse - 3) : 0);
  };
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_NEAR(seed.trend_ms, 4.5, kTolerance);  // 9 pulses apart
  EXPECT_NEAR(seed.amd_ms, 1 + 2.25, kTolerance);
}

TEST(PipelineScorerTest, ShareBelowHalfAPeriodIsStrict) {
  TestCapture capture(1, 2);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(camera == 1 && pulse >= 5 ? 10 : 0);  // exactly half a period
  };
  EXPECT_DOUBLE_EQ(score(capture, arrival_setup()).share_below_half_period, 0.2);
}

// Emits what the test tells it to, in place of gathering.
class ScriptedGatherer final : public Gatherer {
 public:
  ScriptedGatherer(GatheringSetup setup, std::vector<std::vector<std::int64_t>> sets)
      : setup_(setup), sets_(std::move(sets)) {}
  void push(const GatherFrame&, FrameSetSink& sink) override {
    for (const std::vector<std::int64_t>& pulses : std::exchange(sets_, {})) {
      std::vector<GatherFrame> set;
      for (std::size_t i = 0; i < pulses.size(); ++i) {
        set.push_back({.source = static_cast<std::uint32_t>(i), .tag = pulses[i]});
      }
      sink.on_set(set);
    }
  }
  std::uint64_t discarded() const override { return 7; }

 private:
  GatheringSetup setup_;
  std::vector<std::vector<std::int64_t>> sets_;
};

TEST(PipelineScorerTest, CountsSetsWithAnEvaluatedMember) {
  ScorerSetup setup = arrival_setup();
  setup.gathering_interval_periods = 0.25;
  setup.gathering_queue_frames = 9;
  GatheringSetup given;
  setup.make_gatherer = [&](const GatheringSetup& gathering) {
    given = gathering;
    const std::vector<std::vector<std::int64_t>> sets = {
        {3, 3}, {12, 12},                      // pure
        {2, 3}, {12, 13},                      // across an end of the evaluated pulses
        {4, 5}, {-1, 6},                       // mixed
        {2, 2}, {13, 13}, {-1, -1}, {2, 13}};  // without an evaluated member
    return std::make_unique<ScriptedGatherer>(gathering, sets);
  };
  const SeedScore seed = score(TestCapture(1, 2), setup);
  EXPECT_EQ(seed.sets.emitted, 6);
  EXPECT_EQ(seed.sets.pure, 2);
  EXPECT_EQ(seed.sets.discarded_frames, 7);
  EXPECT_EQ(given.sources, 2U);
  EXPECT_EQ(given.period, from_ms(20));
  EXPECT_EQ(given.interval, from_ms(5));
  EXPECT_EQ(given.queue_limit, 9U);
}

TEST(PipelineScorerTest, GatheredSetsHaveScoresOfTheirOwn) {
  TestCapture capture(1, 3);
  capture.late_by = staircase;
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) { return camera == 0 && pulse == 5; };
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_EQ(seed.sets.emitted, 9);
  EXPECT_EQ(seed.sets.index_errors, 0);
  EXPECT_EQ(seed.sets.partial, 0);
  EXPECT_NEAR(seed.set_amd_ms, 2, kTolerance);
  EXPECT_NEAR(seed.set_absolute_error_ms, 11, kTolerance);
  // Algorithm 3 emits as soon as the last member is there.
  EXPECT_NEAR(seed.emission_latency_ms, 0, kTolerance);
  EXPECT_NEAR(seed.emission_latency_max_ms, 0, kTolerance);
}

TEST(PipelineScorerTest, SetsOfARelativeEstimatorAreComparedOnItsAnchor) {
  ScorerSetup setup = arrival_setup();
  class SensorTime final : public DeviceTimeEstimator {
   public:
    GlobalTime stamp(const DeviceSample& sample) override {
      if (!first_) first_ = sample.sensor;
      return GlobalTime(sample.sensor - *first_);
    }
    bool relative() const override { return true; }

   private:
    std::optional<DeviceTime> first_;
  };
  setup.make_estimator = [](std::size_t) { return std::make_unique<SensorTime>(); };
  const SeedScore seed = score(TestCapture(2, 2), setup);
  EXPECT_EQ(seed.sets.pure, 10);
  EXPECT_NEAR(seed.absolute_error_ms, 10, kTolerance);
  EXPECT_NEAR(seed.set_absolute_error_ms, 10, kTolerance);
}

TEST(PipelineScorerTest, HostsFurtherApartThanTheIntervalGiveNoSet) {
  TestCapture capture(2, 2);
  capture.host_errors = {Nanoseconds(0), from_ms(540.0 - 10.5)};  // 9.5 ms past a half period
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_EQ(seed.sets.emitted, 0);
  EXPECT_EQ(seed.sets.complete_pulses, 10);
  EXPECT_NEAR(seed.amd_ms, 529.5, kTolerance);
}

TEST(PipelineScorerTest, HostsAPeriodApartGiveWrongSetsSilently) {
  TestCapture capture(2, 2);
  capture.host_errors = {Nanoseconds(0), from_ms(20)};
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_EQ(seed.sets.emitted, 9);
  EXPECT_EQ(seed.sets.pure, 0);
}

TEST(PipelineScorerTest, OfflineStampsFollowTheEndOfTheCapture) {
  TestCapture capture(2, 2);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(camera == 3 ? 2 : 0) + from_ms(pulse % 2 == 0 ? 0.5 : 0);
  };
  ScorerSetup setup = arrival_setup();
  setup.make_estimator = [](std::size_t) { return make_offline_regression(); };
  setup.make_second_estimator = setup.make_estimator;
  const SeedScore seed = score(capture, setup);
  EXPECT_NEAR(seed.amd_ms, 2, 2e-6);
  EXPECT_EQ(seed.sets.pure, 10);
  EXPECT_DOUBLE_EQ(seed.offline_amd_ms, seed.amd_ms);
  // One line over ten pulses: residuals of +-0.25 ms leave a bias of 10.25 ms and no more.
  EXPECT_NEAR(seed.bias_ms, 10.25 + 0.5, 0.01);
}

TEST(PipelineScorerTest, TheSecondEstimatorLeavesTheScoresAlone) {
  TestCapture capture(2, 2);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(0.1 * static_cast<double>((camera * 7 + pulse * 5) % 11));
  };
  ScorerSetup setup = arrival_setup();
  setup.make_estimator = [](std::size_t) { return make_regression(RegressionWindow{30}); };
  const SeedScore alone = score(capture, setup);
  setup.make_second_estimator = [](std::size_t) { return make_offline_regression(); };
  const SeedScore with_second = score(capture, setup);
  EXPECT_EQ(alone.amd_ms, with_second.amd_ms);
  EXPECT_EQ(alone.sets.pure, with_second.sets.pure);
  EXPECT_LT(with_second.offline_amd_ms, with_second.amd_ms);
}

TEST(PipelineScorerTest, StampsOutOfAllBoundsStaySubtractable) {
  class Wild final : public DeviceTimeEstimator {
   public:
    GlobalTime stamp(const DeviceSample&) override {
      return (high_ = !high_) ? GlobalTime::max() : GlobalTime::min();
    }

   private:
    bool high_ = false;
  };
  ScorerSetup setup = arrival_setup();
  const auto shared = std::make_shared<Wild>();
  class Alternate final : public DeviceTimeEstimator {
   public:
    explicit Alternate(std::shared_ptr<Wild> wild) : wild_(std::move(wild)) {}
    GlobalTime stamp(const DeviceSample& sample) override { return wild_->stamp(sample); }

   private:
    std::shared_ptr<Wild> wild_;
  };
  setup.make_estimator = [&](std::size_t) { return std::make_unique<Alternate>(shared); };
  const SeedScore seed = score(TestCapture(1, 2), setup);
  EXPECT_NEAR(seed.amd_ms, std::ldexp(1.0, 63) * 1e-6, 1e3);
}

TEST(PipelineScorerTest, KeepsOnlyFailedOutcomes) {
  TestCapture capture(3, 1);
  capture.outcomes = {{.slave = 1, .synchronised = true, .passes = 1, .message = ""},
                      {.slave = 2, .synchronised = false, .passes = 200, .message = "threshold"}};
  const SeedScore seed = score(capture, arrival_setup());
  ASSERT_EQ(seed.failures.size(), 1U);
  EXPECT_EQ(seed.failures[0].slave, 2U);
  EXPECT_EQ(seed.failures[0].message, "threshold");
}

}  // namespace
}  // namespace simbench::evaluation
