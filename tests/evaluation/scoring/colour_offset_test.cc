#include "evaluation/scoring/colour_offset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <functional>

#include "evaluation/scoring/pipeline_scorer.h"
#include "tests/evaluation/test_capture.h"

namespace simbench::evaluation {
namespace {

using testing::IsNan;

constexpr double kStampStepMs = 1e-6;
constexpr double kDepthPeriodMs = 20;  // of depth, as of colour unless a test says otherwise

RigLayout colour_rig(std::uint32_t cameras) {
  RigLayout layout{.hosts = 1, .cameras = {}, .frame_rate_hz = 50, .first_pulse = 3, .pulses = 10};
  layout.cameras.resize(cameras);
  return layout;
}

FrameRecord stream_frame(std::uint32_t camera, StreamKind stream, std::uint32_t counter) {
  FrameRecord frame;
  frame.camera = camera;
  frame.stream = stream;
  frame.counter = counter;
  return frame;
}

FrameTruth exposed_at(double mid_ms, std::int64_t pulse = -1) {
  FrameTruth truth;
  truth.pulse = pulse;
  truth.exposure_start = TrueTime(from_ms(mid_ms - 4));
  truth.exposure_end = TrueTime(from_ms(mid_ms + 4));
  return truth;
}

void add_depth(ColourOffset& offsets, std::uint32_t camera, double mid_ms, std::int64_t pulse) {
  offsets.add(stream_frame(camera, StreamKind::kDepth, 0), exposed_at(mid_ms, pulse));
}

void add_colour(ColourOffset& offsets, std::uint32_t camera, double mid_ms, std::uint32_t counter) {
  offsets.add(stream_frame(camera, StreamKind::kColour, counter), exposed_at(mid_ms));
}

SeedScore scored(ColourOffset& offsets) {
  SeedScore score;
  offsets.add_to(score);
  return score;
}

// Depth at pulse p is at 20 p ms; colour of camera c is `late_ms(c)` after it.
ColourOffset rig_with_colour_late_by(std::uint32_t cameras,
                                     const std::function<double(std::uint32_t)>& late_ms) {
  ColourOffset offsets(colour_rig(cameras));
  for (std::int64_t pulse = 0; pulse < 14; ++pulse) {
    const double at_ms = kDepthPeriodMs * static_cast<double>(pulse);
    for (std::uint32_t camera = 0; camera < cameras; ++camera) {
      add_depth(offsets, camera, at_ms, pulse);
      add_colour(offsets, camera, at_ms + late_ms(camera), static_cast<std::uint32_t>(pulse));
    }
  }
  return offsets;
}

TEST(ColourOffset, MeanOfAbsoluteValuesAndRangeOverTheCameras) {
  ColourOffset offsets =
      rig_with_colour_late_by(3, [](std::uint32_t camera) { return 3.0 * camera - 2; });
  const SeedScore score = scored(offsets);  // -2, 1 and 4 ms
  EXPECT_NEAR(score.colour_offset_ms, 7.0 / 3, kStampStepMs);
  EXPECT_NEAR(score.colour_offset_spread_ms, 6, kStampStepMs);
}

TEST(ColourOffset, ColourOfTheSameInstantHasNone) {
  ColourOffset offsets = rig_with_colour_late_by(2, [](std::uint32_t) { return 0; });
  const SeedScore score = scored(offsets);
  EXPECT_EQ(score.colour_offset_ms, 0);
  EXPECT_EQ(score.colour_offset_spread_ms, 0);
}

// 14 ms late is 6 ms early of the next: nothing says which is meant.
TEST(ColourOffset, TheNearestFrameCounts) {
  ColourOffset offsets = rig_with_colour_late_by(1, [](std::uint32_t) { return 14; });
  EXPECT_NEAR(scored(offsets).colour_offset_ms, 6, kStampStepMs);
}

TEST(ColourOffset, ASingleCameraHasNoSpread) {
  ColourOffset offsets = rig_with_colour_late_by(1, [](std::uint32_t) { return 5; });
  const SeedScore score = scored(offsets);
  EXPECT_NEAR(score.colour_offset_ms, 5, kStampStepMs);
  EXPECT_THAT(score.colour_offset_spread_ms, IsNan());
}

// Colour at 90 Hz beside depth at 45, as a GenLock rig of D455 has it: over many phases, uniform in
// a period T of colour, the mean is T/4, the spread of 6 cameras 5/7 T.
TEST(ColourOffset, ColourThatRunsFreeIsAQuarterOfItsPeriodAway) {
  constexpr double kColourMs = 1000.0 / 90;
  constexpr int kRigs = 4000;
  boost::random::mt19937_64 random(1);
  boost::random::uniform_real_distribution<double> phase_ms(0, kColourMs);
  double mean_ms = 0;
  double spread_ms = 0;
  for (int rig = 0; rig < kRigs; ++rig) {
    ColourOffset offsets(colour_rig(6));
    for (std::uint32_t camera = 0; camera < 6; ++camera) {
      const double first_ms = phase_ms(random);
      for (std::int64_t pulse = 3; pulse < 6; ++pulse) {
        add_depth(offsets, camera, 2 * kColourMs * static_cast<double>(pulse), pulse);
      }
      for (std::uint32_t frame = 0; frame < 14; ++frame) {
        add_colour(offsets, camera, first_ms + kColourMs * frame, frame);
      }
    }
    const SeedScore score = scored(offsets);
    mean_ms += score.colour_offset_ms / kRigs;
    spread_ms += score.colour_offset_spread_ms / kRigs;
  }
  // Four standard errors: |offset| deviates by T/sqrt(48), the range by T sqrt(10/392).
  EXPECT_NEAR(mean_ms, kColourMs / 4, 4 * kColourMs / std::sqrt(48 * 6 * kRigs));
  EXPECT_NEAR(spread_ms, kColourMs * 5 / 7, 4 * kColourMs * std::sqrt(10.0 / 392 / kRigs));
}

TEST(ColourOffset, BesideALostFrameTheNearestIsUnknown) {
  ColourOffset offsets(colour_rig(1));
  add_depth(offsets, 0, 60, 3);  // before the first colour frame
  add_colour(offsets, 0, 61, 7);
  add_depth(offsets, 0, 80, 4);  // between 7 and 9: 8 was lost
  add_colour(offsets, 0, 101, 9);
  add_depth(offsets, 0, 100, 5);  // likewise
  add_depth(offsets, 0, 120, 6);  // known: 1 ms
  add_colour(offsets, 0, 121, 10);
  add_depth(offsets, 0, 140, 7);  // after the last
  EXPECT_NEAR(scored(offsets).colour_offset_ms, 1, kStampStepMs);
}

TEST(ColourOffset, TheOrderOfDeliveryDoesNotMatter) {
  ColourOffset offsets(colour_rig(1));
  add_colour(offsets, 0, 122, 2);
  add_colour(offsets, 0, 82, 0);
  add_colour(offsets, 0, 102, 1);
  add_depth(offsets, 0, 100, 5);
  EXPECT_NEAR(scored(offsets).colour_offset_ms, 2, kStampStepMs);
}

TEST(ColourOffset, OnlyEvaluatedPulsesCount) {
  ColourOffset offsets(colour_rig(1));
  add_colour(offsets, 0, 0, 0);
  add_colour(offsets, 0, 20, 1);
  add_depth(offsets, 0, 5, 2);
  add_depth(offsets, 0, 6, 13);
  add_depth(offsets, 0, 7, -1);
  EXPECT_THAT(scored(offsets).colour_offset_ms, IsNan());
}

TEST(ColourOffset, APipelineHasItWhereTheRigHasBothStreamsAndTruth) {
  TestCapture capture(1, 2);
  ScorerSetup setup = arrival_setup();
  EXPECT_THAT(score(capture, setup).colour_offset_ms, IsNan());
  setup.has_depth_and_colour = true;
  EXPECT_THAT(score(capture, setup).colour_offset_ms, IsNan()) << "no colour frame came";
  for (const bool with_truth : {true, false}) {
    PipelineScorer scorer(setup);
    capture.with_truth = with_truth;
    scorer.on_start(capture.layout);
    for (std::int64_t pulse = 0; pulse < 14; ++pulse) {
      for (std::uint32_t camera = 0; camera < 2; ++camera) {
        capture.deliver(camera, pulse, scorer);
        const FrameRecord colour =
            stream_frame(camera, StreamKind::kColour, static_cast<std::uint32_t>(pulse));
        FrameTruth truth = exposed_at(to_ms(TestCapture::at(pulse).time_since_epoch()) + 2);
        scorer.on_frame(colour, with_truth ? &truth : nullptr);
      }
    }
    const SeedScore score = scorer.finish();
    if (with_truth) {
      EXPECT_NEAR(score.colour_offset_ms, 2, kStampStepMs);
      EXPECT_NEAR(score.colour_offset_spread_ms, 0, kStampStepMs);
    } else {
      EXPECT_THAT(score.colour_offset_ms, IsNan());
    }
  }
}

}  // namespace
}  // namespace simbench::evaluation
