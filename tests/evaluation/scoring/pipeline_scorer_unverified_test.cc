// The scorer with captures of which nobody knows which frames belong together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "algorithms/device_time/yoon2021.h"
#include "algorithms/gathering/gatherers.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "recording/forwarding_sink.h"
#include "tests/evaluation/test_capture.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsNan;

TestCapture capture_without_truth(std::uint32_t hosts, std::uint32_t cameras_per_host) {
  TestCapture capture(hosts, cameras_per_host);
  capture.with_truth = false;
  return capture;
}

// Lets the test change each frame on its way.
class Edited final : public ForwardingSink {
 public:
  Edited(RecordingSink& sink, std::function<void(FrameRecord&)> edit)
      : ForwardingSink(sink), edit_(std::move(edit)) {}
  void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) override {
    std::vector<FrameRecord> edited(frames.begin(), frames.end());
    for (FrameRecord& frame : edited) edit_(frame);
    sink().on_frames(edited, truths);
  }

 private:
  std::function<void(FrameRecord&)> edit_;
};

SeedScore score_edited(const TestCapture& capture, const std::function<void(FrameRecord&)>& edit) {
  PipelineScorer scorer(arrival_setup());
  Edited edited(scorer, edit);
  capture.record(edited);
  return scorer.finish();
}

TEST(PipelineScorerUnverified, ScoresTheGatheredSets) {
  TestCapture capture = capture_without_truth(2, 3);
  capture.late_by = staircase;
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_EQ(seed.ground_truth, GroundTruth::kNone);
  EXPECT_NEAR(seed.amd_ms, 5, kTolerance);
  EXPECT_NEAR(seed.rmdv_ms, std::sqrt((9.0 + 4 + 1 + 0 + 1 + 4) / 6), kTolerance);
  EXPECT_TRUE(std::isnan(seed.rmdv_printed_sqrt_ms));  // mean 2.5, upper-middle 3: no real root
  EXPECT_DOUBLE_EQ(seed.rmdv_printed_share, 0);
  EXPECT_NEAR(seed.set_amd_ms, 5, kTolerance);
  EXPECT_NEAR(seed.emission_latency_ms, 0, kTolerance);
  EXPECT_NEAR(seed.emission_latency_max_ms, 0, kTolerance);
}

TEST(PipelineScorerUnverified, WhatNeedsPulsesOrTruthDoesNotExist) {
  const SeedScore seed = score(capture_without_truth(2, 2), arrival_setup());
  for (const double absent :
       {seed.absolute_error_ms, seed.bias_ms, seed.host_error_ms, seed.exposure_spread_ms,
        seed.set_absolute_error_ms, seed.share_below_half_period, seed.trend_ms,
        seed.spread_in_host_ms, seed.spread_between_hosts_ms}) {
    EXPECT_THAT(absent, IsNan());
  }
  EXPECT_THAT(seed.host_errors_ms, Each(IsNan()));
  EXPECT_EQ(seed.sets.pure, 0);
  EXPECT_EQ(seed.sets.complete_pulses, 0);
  EXPECT_EQ(seed.sets.index_errors, 0);
}

// 3 frames of warm-up at 50 Hz: what arrives from 60 ms after the first frame is evaluated, for as
// long as 10 frames take.
TEST(PipelineScorerUnverified, SetsOfOneCameraHaveNoRange) {
  const SeedScore seed = score(capture_without_truth(1, 1), arrival_setup());
  EXPECT_THAT(seed.amd_ms, IsNan());
  for (const PulseScore& set : nonempty(seed.pulses)) {
    EXPECT_THAT(set.spread_ms, IsNan());
    EXPECT_THAT(set.deviation_ms, IsNan());
  }
}

TEST(PipelineScorerUnverified, WarmUpAndEndAreCountedInTime) {
  TestCapture capture = capture_without_truth(1, 2);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(pulse < 3 ? 8.0 * camera : 1.0 * camera);
  };
  EXPECT_NEAR(score(capture, arrival_setup()).amd_ms, 1, kTolerance);
  EXPECT_EQ(score(capture, arrival_setup()).sets.emitted, 10);

  PipelineScorer longer(arrival_setup());
  longer.on_start(capture.layout);
  for (std::int64_t pulse = 0; pulse < 100; ++pulse) {
    for (std::uint32_t camera = 0; camera < 2; ++camera) capture.deliver(camera, pulse, longer);
  }
  const SeedScore seed = longer.finish();
  // Camera 1 is 1 ms late: of its frames, that of pulse 12 is the last in time, as of camera 0.
  EXPECT_EQ(seed.sets.emitted, 10);
  EXPECT_EQ(seed.frames.delivered, 20);
}

TEST(PipelineScorerUnverified, EachHostHasItsOwnSteadyClock) {
  TestCapture capture = capture_without_truth(2, 1);
  const SeedScore seed = score_edited(capture, [](FrameRecord& frame) {
    if (frame.camera == 1) frame.arrival_steady += std::chrono::hours(700);
  });
  EXPECT_EQ(seed.sets.emitted, 10);
  EXPECT_EQ(seed.frames.delivered, 20);
}

TEST(PipelineScorerUnverified, LostFramesAreGapsOfTheCounters) {
  TestCapture capture = capture_without_truth(1, 3);
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
    return (camera == 0 && (pulse == 5 || pulse == 6)) || (camera == 2 && pulse == 9);
  };
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_EQ(seed.frames.expected, 30);
  EXPECT_EQ(seed.frames.delivered, 27);
  EXPECT_EQ(seed.frames.dropped, 3);
  EXPECT_EQ(seed.sets.emitted, 7);
  EXPECT_EQ(seed.sets.discarded_frames, 2 + 2 + 2);  // the others' frames of three pulses
}

TEST(PipelineScorerUnverified, ACounterMayWrapOrBeginAnew) {
  TestCapture capture = capture_without_truth(1, 1);
  capture.lost = [](std::uint32_t, std::int64_t pulse) { return pulse == 8; };
  const SeedScore wrapping = score_edited(capture, [](FrameRecord& frame) {
    frame.counter += 0xFFFFFFFFU - 6;  // pulse 7 has the register's zero
  });
  EXPECT_EQ(wrapping.frames.dropped, 1);
  const SeedScore anew = score_edited(capture, [](FrameRecord& frame) {
    if (frame.counter < 6) frame.counter += 5'000'000;
  });
  EXPECT_EQ(anew.frames.dropped, 1);
}

// The reason for the label: neighbours are mixed in every set, and the score cannot tell.
TEST(PipelineScorerUnverified, ConsistentMixingLooksPerfect) {
  TestCapture capture(2, 2);
  capture.host_errors = {Nanoseconds(0), from_ms(20)};  // a period
  EXPECT_EQ(score(capture, arrival_setup()).sets.pure, 0);
  capture.with_truth = false;
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_GE(seed.sets.emitted, 9);
  EXPECT_NEAR(seed.amd_ms, 0, kTolerance);
}

TEST(PipelineScorerUnverified, HostErrorsExistWhereSomebodyKnowsThem) {
  PipelineScorer scorer(arrival_setup());
  const TestCapture capture = capture_without_truth(2, 1);
  scorer.on_start(capture.layout);
  const std::vector<Nanoseconds> errors = {Nanoseconds(0), from_ms(-3)};
  for (std::int64_t pulse = 0; pulse < 13; ++pulse) {
    scorer.on_event(PulseTruth{pulse, TestCapture::at(pulse), errors});
    for (std::uint32_t camera = 0; camera < 2; ++camera) capture.deliver(camera, pulse, scorer);
  }
  const SeedScore seed = scorer.finish();
  EXPECT_EQ(seed.ground_truth, GroundTruth::kNone);
  EXPECT_NEAR(seed.host_error_ms, 3, kTolerance);
}

// A gatherer that counts from the first frame is given the warm-up; its sets there do not count.
TEST(PipelineScorerUnverified, SetsOfTheWarmUpDoNotCount) {
  TestCapture capture = capture_without_truth(1, 2);
  capture.late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(pulse < 3 ? 8.0 * camera : 1.0 * camera);
  };
  ScorerSetup setup = arrival_setup();
  setup.make_gatherer = [](const GatheringSetup& gathering) {
    return make_genlock_gatherer(gathering, GenlockOrder::Variant::kReanchored);
  };
  const SeedScore seed = score(capture, setup);
  EXPECT_EQ(seed.sets.emitted, 10);
  EXPECT_NEAR(seed.amd_ms, 1, kTolerance);
}

TEST(PipelineScorerUnverified, TheOracleOfGatheringNeedsPulses) {
  ScorerSetup setup = arrival_setup();
  setup.gatherer_needs_pulses = true;
  try {
    score(capture_without_truth(1, 2), setup);
    FAIL() << "nothing was thrown";
  } catch (const RecordingFailed& failed) {
    EXPECT_THAT(failed.what(), HasSubstr("gathering \"oracle\""));
  }
  setup.genlock = true;  // GenLock order tells the pulses
  EXPECT_NO_THROW(score(capture_without_truth(1, 2), setup));
}

TEST(PipelineScorerUnverified, GroundTruthIsReported) {
  EXPECT_EQ(score(TestCapture(1, 2), arrival_setup()).ground_truth, GroundTruth::kSimulation);
  ScorerSetup genlock = arrival_setup();
  genlock.genlock = true;
  EXPECT_EQ(score(TestCapture(1, 2), genlock).ground_truth, GroundTruth::kSimulation);
  EXPECT_EQ(score(capture_without_truth(1, 2), genlock).ground_truth, GroundTruth::kGenlockOrder);
}

TEST(PipelineScorerUnverified, ACaptureWithoutFramesHasNoScores) {
  TestCapture capture = capture_without_truth(1, 2);
  capture.lost = [](std::uint32_t, std::int64_t) { return true; };
  const SeedScore seed = score(capture, arrival_setup());
  EXPECT_THAT(seed.amd_ms, IsNan());
  EXPECT_THAT(seed.set_amd_ms, IsNan());
  EXPECT_EQ(seed.ground_truth, GroundTruth::kNone);
}

}  // namespace
}  // namespace simbench::evaluation
