// The scorer with GenLock captures: relative stamps, GenLock order against and without the truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "algorithms/device_time/yoon2021.h"
#include "algorithms/gathering/gatherers.h"
#include "evaluation/scoring/pipeline_scorer.h"
#include "tests/evaluation/test_capture.h"

namespace simbench::evaluation {
namespace {

using ::testing::Each;
using ::testing::IsNan;

ScorerSetup genlock_setup() {
  ScorerSetup setup;
  setup.genlock = true;
  setup.make_estimator = [](std::size_t) { return make_sensor_normalised(); };
  setup.make_gatherer = [](const GatheringSetup& gathering) {
    return make_genlock_gatherer(gathering, GenlockOrder::Variant::kReanchored);
  };
  return setup;
}

// Each camera's clock has its own zero.
Nanoseconds own_zero(std::uint32_t camera, std::int64_t) {
  return std::chrono::seconds(5 * camera);
}

TEST(PipelineScorerGenlockTest, RelativeStampsGetTheArrivalOfTheMastersFirstFrame) {
  TestCapture capture(2, 2);
  capture.sensor_late_by = own_zero;
  // Camera 0 is the master's first, though others deliver before it.
  capture.late_by = [](std::uint32_t camera, std::int64_t) { return from_ms(camera == 0 ? 3 : 0); };
  const SeedScore seed = score(capture, genlock_setup());
  EXPECT_NEAR(seed.amd_ms, 0, kTolerance);
  EXPECT_NEAR(seed.bias_ms, 13, kTolerance);
  EXPECT_NEAR(seed.absolute_error_ms, 13, kTolerance);
  EXPECT_EQ(seed.sets.pure, 10);
  EXPECT_EQ(seed.genlock_index_errors, 0);
}

TEST(PipelineScorerGenlockTest, WithoutACameraOnTheMasterTheFirstFrameAnchors) {
  TestCapture capture(2, 1);
  capture.layout.cameras = {{.host = 1}, {.host = 1}};
  const SeedScore seed = score(capture, genlock_setup());
  EXPECT_NEAR(seed.bias_ms, 10, kTolerance);
}

TEST(PipelineScorerGenlockTest, ALostFirstFrameShiftsGenlockOrder) {
  TestCapture capture(1, 3);
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) { return camera == 2 && pulse == 0; };
  const SeedScore seed = score(capture, genlock_setup());
  EXPECT_EQ(seed.frames.dropped, 0);
  EXPECT_EQ(seed.genlock_index_errors, 12);
  EXPECT_NEAR(seed.amd_ms, 20, kTolerance);
  EXPECT_EQ(seed.sets.pure, 0);
  EXPECT_GT(seed.sets.emitted, 0);
}

TEST(PipelineScorerGenlockTest, ALaterLossLeavesGenlockOrderAlone) {
  TestCapture capture(1, 3);
  capture.lost = [](std::uint32_t camera, std::int64_t pulse) {
    return camera == 2 && (pulse == 1 || pulse == 7);
  };
  const SeedScore seed = score(capture, genlock_setup());
  EXPECT_EQ(seed.genlock_index_errors, 0);
  EXPECT_EQ(seed.sets.pure, 9);
  EXPECT_EQ(seed.sets.emitted, 9);
}

TEST(PipelineScorerGenlockTest, WithoutTruthGenlockOrderGroups) {
  TestCapture capture(2, 2);
  capture.with_truth = false;
  capture.sensor_late_by = own_zero;
  capture.late_by = staircase;
  ScorerSetup setup = arrival_setup();
  setup.genlock = true;
  const SeedScore seed = score(capture, setup);
  EXPECT_NEAR(seed.amd_ms, 3, kTolerance);
  EXPECT_EQ(seed.frames.delivered, 40);
  EXPECT_EQ(seed.sets.pure, 10);
  EXPECT_THAT(seed.absolute_error_ms, IsNan());
  EXPECT_THAT(seed.bias_ms, IsNan());
  EXPECT_THAT(seed.host_error_ms, IsNan());
  EXPECT_THAT(seed.exposure_spread_ms, IsNan());
  EXPECT_THAT(seed.host_errors_ms, Each(IsNan()));
}

}  // namespace
}  // namespace simbench::evaluation
