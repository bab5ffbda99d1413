#include "evaluation/scoring/alignment_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>

#include "tests/evaluation/test_capture.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using testing::Each;
using testing::IsNan;

constexpr std::int64_t kFramesPerSecond = 50;  // of a TestCapture
constexpr double kNanosecondsInMs = 1e-6;

// Exposures of three cameras: 2 s of warm-up, then 8 s that are evaluated. Pulse p is p * 20 ms
// after the first, whose exposure begins 4 ms earlier.
struct SteeredCapture : TestCapture {
  SteeredCapture() : TestCapture(1, 3) {
    layout.first_pulse = 2 * kFramesPerSecond;
    layout.pulses = 8 * kFramesPerSecond;
  }

  SeedScore scored(const std::vector<AlignmentReport>& reports = {}) const {
    ScorerSetup setup = arrival_setup();
    setup.is_steered = true;
    setup.unsteady_start = unsteady_start;
    PipelineScorer scorer(setup);
    record(scorer);
    for (const AlignmentReport& report : reports) scorer.on_event(report);
    return scorer.finish();
  }

  Nanoseconds unsteady_start{};
};

std::vector<double> all_of(const SeedScore& score) {
  return {score.exposure_spread_median_ms,
          score.exposure_spread_p95_ms,
          score.aligned_1_ms_s,
          score.aligned_0_1_ms_s,
          score.aligned_0_01_ms_s,
          score.disturbed_frames,
          score.exposure_drift_ppm,
          score.wrong_locks};
}

// Camera 2 exposes that much later than the others.
TestCapture::PerFrame third_later(std::function<double(std::int64_t pulse)> ms) {
  return [ms](std::uint32_t camera, std::int64_t pulse) {
    return camera == 2 ? from_ms(ms(pulse)) : Nanoseconds(0);
  };
}

TEST(AlignmentScores, MedianAndQuantileOfTheSpread) {
  SteeredCapture capture;
  // 0, 0.01, ... 3.99 ms at the 400 evaluated pulses; 9 ms before them does not count.
  capture.exposed_late_by = third_later(
      [](std::int64_t pulse) { return pulse < 100 ? 9 : static_cast<double>(pulse - 100) / 100; });
  const SeedScore score = capture.scored();
  EXPECT_NEAR(score.exposure_spread_median_ms, 1.995, kNanosecondsInMs);
  EXPECT_NEAR(score.exposure_spread_p95_ms, 0.95 * 3.99, kNanosecondsInMs);
  EXPECT_NEAR(score.exposure_spread_ms, 1.995, kNanosecondsInMs);
}

TEST(AlignmentScores, PulsesThatACameraLacksHaveNoSpread) {
  SteeredCapture capture;
  capture.exposed_late_by = third_later([](std::int64_t pulse) { return pulse % 2 == 0 ? 3 : 1; });
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
    return camera == 1 && pulse % 2 == 0;
  };
  const SeedScore score = capture.scored();
  EXPECT_NEAR(score.exposure_spread_median_ms, 1, kNanosecondsInMs);
  EXPECT_NEAR(score.exposure_spread_p95_ms, 1, kNanosecondsInMs);
}

// The second that begins with the first exposure, 4 ms before the middle of pulse 0, ends before
// pulse 50: 4 ms + 50 * 20 ms.
TEST(AlignmentScores, AlignedFromTheSecondOnInWhichTheSpreadFalls) {
  SteeredCapture capture;
  capture.exposed_late_by = third_later([](std::int64_t pulse) {
    if (pulse < 50) return 5.0;            // the first second
    if (pulse < 4 * 50) return 0.5;        // until 4 s
    return pulse < 7 * 50 ? 0.05 : 0.005;  // until 7 s, and later
  });
  const SeedScore score = capture.scored();
  EXPECT_DOUBLE_EQ(score.aligned_1_ms_s, 1) << "the warm-up counts";
  EXPECT_DOUBLE_EQ(score.aligned_0_1_ms_s, 4);
  EXPECT_DOUBLE_EQ(score.aligned_0_01_ms_s, 7);
}

TEST(AlignmentScores, AlignedFromTheBeginningOrNever) {
  SteeredCapture capture;
  capture.exposed_late_by = third_later([](std::int64_t) { return 0.05; });
  const SeedScore score = capture.scored();
  EXPECT_EQ(score.aligned_1_ms_s, 0);
  EXPECT_EQ(score.aligned_0_1_ms_s, 0);
  EXPECT_THAT(score.aligned_0_01_ms_s, IsNan());
}

TEST(AlignmentScores, ALaterStepBeginsTheTimeAnew) {
  SteeredCapture capture;
  capture.exposed_late_by =
      third_later([](std::int64_t pulse) { return pulse / 50 == 5 ? 2.0 : 0.005; });
  const SeedScore score = capture.scored();
  EXPECT_DOUBLE_EQ(score.aligned_1_ms_s, 6);
  EXPECT_DOUBLE_EQ(score.aligned_0_01_ms_s, 6);
}

TEST(AlignmentScores, AFewPulsesOfASecondDoNotCount) {
  SteeredCapture capture;
  capture.exposed_late_by =
      third_later([](std::int64_t pulse) { return pulse % 50 < 20 ? 2.0 : 0.005; });
  EXPECT_EQ(capture.scored().aligned_0_01_ms_s, 0);
}

TEST(AlignmentScores, ALengthenedFrameIsDisturbedOnce) {
  SteeredCapture capture;
  // Camera 1: frame 40, of the warm-up, is 3 ms longer, and those after it are as usual; frame 300
  // is 0.1 ms longer, half a percent.
  capture.exposed_late_by = [](std::uint32_t camera, std::int64_t pulse) {
    if (camera != 1) return Nanoseconds(0);
    return from_ms((pulse > 40 ? 3 : 0) + (pulse > 300 ? 0.1 : 0));
  };
  EXPECT_DOUBLE_EQ(capture.scored().disturbed_frames, 1.0 / 3);
}

TEST(AlignmentScores, JitterDisturbsNoFrame) {
  SteeredCapture capture;
  capture.exposed_late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return Nanoseconds((pulse * 7919 + camera * 104'729) % 20'000);  // 20 us of 20 ms
  };
  EXPECT_EQ(capture.scored().disturbed_frames, 0);
}

TEST(AlignmentScores, TheUnsteadyStartDoesNotCount) {
  SteeredCapture capture;
  // Until 1 s every second frame of camera 1 is 1 ms late.
  capture.exposed_late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return from_ms(camera == 1 && pulse < 50 && pulse % 2 == 1 ? 1 : 0);
  };
  EXPECT_DOUBLE_EQ(capture.scored().disturbed_frames, 50.0 / 3);
  capture.unsteady_start = from_ms(1000);
  EXPECT_EQ(capture.scored().disturbed_frames, 0);
  capture.unsteady_start = from_ms(960);  // and a frame more
  EXPECT_DOUBLE_EQ(capture.scored().disturbed_frames, 1.0 / 3);
}

TEST(AlignmentScores, ALostFrameDisturbsNone) {
  SteeredCapture capture;
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
    return camera == 1 && pulse % 10 == 0;
  };
  EXPECT_EQ(capture.scored().disturbed_frames, 0) << "the length around it is unknown";
}

TEST(AlignmentScores, AFrameOfAnotherExposureIsDisturbed) {
  SteeredCapture capture;
  AlignmentScores scores(capture.layout, Nanoseconds(0));
  for (std::uint32_t camera = 0; camera < 3; ++camera) {
    for (std::uint32_t counter = 0; counter < 100; ++counter) {
      FrameTruth truth;
      truth.pulse = counter;
      // The counter wraps after frame 9. Frame 50 of camera 2 is exposed for 9 ms, not for 8.
      const Nanoseconds half = from_ms(camera == 2 && counter == 50 ? 4.5 : 4);
      truth.exposure_start = TestCapture::at(counter) - half;
      truth.exposure_end = TestCapture::at(counter) + half;
      FrameRecord frame;
      frame.camera = camera;
      frame.counter = counter - 10;
      scores.add(frame, truth);
    }
  }
  MetricValues<double> score;
  scores.add_to(score);
  EXPECT_DOUBLE_EQ(score.disturbed_frames, 1.0 / 3);
}

TEST(AlignmentScores, TheDriftIsThatOfTheWorstCamera) {
  SteeredCapture capture;
  // 20 ppm: 0.4 us a frame; camera 1 drifts half as fast the other way.
  capture.exposed_late_by = [](std::uint32_t camera, std::int64_t pulse) {
    return Nanoseconds(camera == 2 ? 400 * pulse : camera == 1 ? -200 * pulse : 0);
  };
  EXPECT_NEAR(capture.scored().exposure_drift_ppm, 20, 1e-6);
}

TEST(AlignmentScores, CorrectionsInAFewSecondsAreNoDrift) {
  SteeredCapture capture;
  // 20 ppm, and 80 us back in the middle of every fourth second.
  capture.exposed_late_by = third_later([](std::int64_t pulse) {
    return 0.0004 * static_cast<double>(pulse) - 0.08 * static_cast<double>((pulse + 75) / 200);
  });
  EXPECT_NEAR(capture.scored().exposure_drift_ppm, 20, 1e-6);
}

TEST(AlignmentScores, APartOfASecondHasNoDrift) {
  SteeredCapture capture;
  capture.layout.pulses = 49;
  EXPECT_THAT(capture.scored().exposure_drift_ppm, IsNan());
  capture.layout.pulses = 50;
  EXPECT_NEAR(capture.scored().exposure_drift_ppm, 0, 1e-9);
}

TEST(AlignmentScores, ACameraThatSaysSoAndIsNotIsAWrongLock) {
  SteeredCapture capture;
  // A tenth of the period is 2 ms.
  capture.exposed_late_by = [](std::uint32_t camera, std::int64_t) {
    return from_ms(camera == 1 ? 1.99 : camera == 2 ? -2.01 : 0);
  };
  const auto wrong_locks = [&capture](bool first, bool second, bool third) {
    return capture
        .scored({{.camera = 0, .aligned = first},
                 {.camera = 1, .aligned = second},
                 {.camera = 2, .aligned = third}})
        .wrong_locks;
  };
  EXPECT_EQ(wrong_locks(true, true, true), 1);
  EXPECT_EQ(wrong_locks(true, true, false), 0);
  EXPECT_EQ(wrong_locks(false, false, false), 0) << "nobody claims anything";
  EXPECT_EQ(capture.scored({{.camera = 2, .aligned = true}}).wrong_locks, 1);
  EXPECT_THAT(capture.scored().wrong_locks, IsNan()) << "nobody reported";
}

TEST(AlignmentScores, TheNewestReportOfACameraCounts) {
  SteeredCapture capture;
  capture.exposed_late_by = third_later([](std::int64_t) { return 5; });
  const AlignmentReport aligned = {.camera = 2, .aligned = true};
  const AlignmentReport lost = {.camera = 2, .aligned = false, .message = "too far"};
  EXPECT_EQ(capture.scored({aligned, lost}).wrong_locks, 0);
  EXPECT_EQ(capture.scored({lost, aligned}).wrong_locks, 1);
}

TEST(AlignmentScores, WhyACameraIsUnalignedIsANote) {
  const SteeredCapture capture;
  const AlignmentReport moving{.camera = 1, .message = "on its way"};
  const AlignmentReport refused{.camera = 2, .message = "the camera has no control adjust_frame"};
  const AlignmentReport aligned{.camera = 1, .aligned = true};
  EXPECT_THAT(capture.scored({refused, moving, aligned}).cost.notes,
              testing::ElementsAre("capture_alignment left a camera unaligned: the camera has no "
                                   "control adjust_frame"));
  EXPECT_THAT(capture.scored({moving, aligned}).cost.notes, testing::IsEmpty());
  EXPECT_THAT(capture.scored().cost.notes, testing::IsEmpty());
}

TEST(AlignmentScores, OfTwoFramesNearOnePulseTheFirstCounts) {
  SteeredCapture capture;
  AlignmentScores scores(capture.layout, Nanoseconds(0));
  const auto expose = [&scores](std::uint32_t camera, std::int64_t pulse, double late_ms) {
    FrameTruth truth;
    truth.pulse = pulse;
    truth.exposure_start = TestCapture::at(pulse) + from_ms(late_ms - 4);
    truth.exposure_end = truth.exposure_start + from_ms(8);
    FrameRecord frame;
    frame.camera = camera;
    scores.add(frame, truth);
  };
  for (std::int64_t pulse = 100; pulse < 200; ++pulse) {
    expose(0, pulse, 0);
    expose(1, pulse, 1);
    expose(2, pulse, -1);
    expose(2, pulse, 7);
  }
  MetricValues<double> score;
  scores.add_to(score);
  EXPECT_NEAR(score.exposure_spread_p95_ms, 2, kNanosecondsInMs);
}

TEST(AlignmentScores, ASingleCameraIsComparedWithNone) {
  SteeredCapture capture;
  capture.layout.cameras.resize(1);
  const SeedScore score = capture.scored({{.camera = 0, .aligned = true}});
  EXPECT_EQ(score.disturbed_frames, 0);
  std::vector<double> others = all_of(score);
  std::erase_if(others, [&score](double value) { return value == score.disturbed_frames; });
  EXPECT_EQ(others.size(), 7U);
  EXPECT_THAT(nonempty(others), Each(IsNan()));
}

TEST(AlignmentScores, OtherCapturesHaveNone) {
  const SteeredCapture steered;
  PipelineScorer scorer(arrival_setup());
  steered.record(scorer);
  scorer.on_event(AlignmentReport{.camera = 1, .aligned = true});
  EXPECT_THAT(nonempty(all_of(scorer.finish())), Each(IsNan()));
}

TEST(AlignmentScores, WithoutTruthOrFramesThereAreNone) {
  SteeredCapture capture;
  capture.with_truth = false;
  EXPECT_THAT(nonempty(all_of(capture.scored({{.camera = 1, .aligned = true}}))), Each(IsNan()));
  capture.with_truth = true;
  capture.lost = [](std::uint32_t, std::int64_t) { return true; };
  EXPECT_THAT(nonempty(all_of(capture.scored({{.camera = 1, .aligned = true}}))), Each(IsNan()));
}

TEST(AlignmentScores, WithoutTheReferenceCameraNothingIsCompared) {
  SteeredCapture capture;
  capture.lost = [](std::uint32_t camera, std::int64_t) { return camera == 0; };
  const SeedScore score = capture.scored({{.camera = 1, .aligned = true}});
  EXPECT_EQ(score.disturbed_frames, 0);
  EXPECT_THAT(score.exposure_spread_median_ms, IsNan());
  EXPECT_THAT(score.aligned_1_ms_s, IsNan());
  EXPECT_THAT(score.wrong_locks, IsNan());
}

}  // namespace
}  // namespace simbench::evaluation
