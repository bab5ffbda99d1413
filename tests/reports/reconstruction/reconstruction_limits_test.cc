#include <gmock/gmock.h>

#include "reports/reconstruction/reconstruction_document.h"
#include "tests/reports/sample_reconstruction.h"

namespace simbench::reports {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;

TEST(SyncLimits, TheLimitIsInterpolatedOnTheSegmentThatCrossesIt) {
  const std::vector<SyncLimit> limits = sync_limits(sample_curve());
  ASSERT_EQ(limits.size(), 2U);
  // 2.2 cm is passed between 10 ms (2.0) and 100 ms (2.9): 0.9 cm in 90 ms, 0.2 cm are 20 ms.
  EXPECT_DOUBLE_EQ(limits[1].speed_m_per_s, 1.2);
  EXPECT_DOUBLE_EQ(limits[1].floor_cm, 2);
  ASSERT_TRUE(limits[1].limit_ms);
  EXPECT_NEAR(*limits[1].limit_ms, 30, 1e-9);
  EXPECT_NEAR(limits[1].cost_cm_per_ms, 0.01, 1e-12);
  EXPECT_EQ(limit_text(limits[1]), "30.0");
}

TEST(SyncLimits, WhatIsNeverPassedHasNoLimitAndTheLastSlope) {
  const SyncLimit limit = sync_limits(sample_curve()).front();
  EXPECT_FALSE(limit.limit_ms);
  EXPECT_NEAR(limit.cost_cm_per_ms, 0.0002, 1e-12);
  EXPECT_EQ(limit_text(limit), "> 100");
}

TEST(SyncLimits, TheFirstCrossingCountsWhateverComesLater) {
  const auto limits = sync_limits({sample_point(1, 0, 1), sample_point(1, 10, 2),
                                   sample_point(1, 20, 1), sample_point(1, 30, 3)});
  ASSERT_TRUE(limits[0].limit_ms);
  EXPECT_NEAR(*limits[0].limit_ms, 1, 1e-9);
}

TEST(SyncLimits, PointsWithoutAValueAreLeftOut) {
  reconstruction::CurvePoint empty = sample_point(1, 5, 0);
  empty.mean_cm = {reconstruction::kNoError, reconstruction::kNoError};
  const auto limits = sync_limits({sample_point(1, 0, 1), empty, sample_point(1, 10, 1.2)});
  ASSERT_TRUE(limits[0].limit_ms);
  EXPECT_NEAR(*limits[0].limit_ms, 5, 1e-9);
  const SyncLimit nothing = sync_limits({empty}).front();
  EXPECT_THAT(nothing.floor_cm, IsNan());
  EXPECT_FALSE(nothing.limit_ms);
  EXPECT_EQ(limit_text(nothing), "-");
  EXPECT_TRUE(sync_limits({}).empty());
}

TEST(SyncLimits, OnePointHasAFloorAndNoSlope) {
  const SyncLimit limit = sync_limits({sample_point(1, 0, 2)}).front();
  EXPECT_DOUBLE_EQ(limit.floor_cm, 2);
  EXPECT_THAT(limit.cost_cm_per_ms, IsNan());
}

TEST(PublishedRatio, IsPairedBySeed) {
  auto results = sample_reconstruction();
  std::swap(results.rows[1].seeds[0], results.rows[1].seeds[2]);  // found by number, not by place
  const auto ratio = published_ratio(results.rows);
  ASSERT_TRUE(ratio);
  EXPECT_EQ(ratio->worst, "ntp_last_set");
  EXPECT_EQ(ratio->best, "yoon2021_both");
  EXPECT_THAT(ratio->ratio.values, ElementsAre(3, DoubleNear(8 / 2.4, 1e-12), 5));
  EXPECT_NEAR(ratio->ratio.median, 8 / 2.4, 1e-12);
  EXPECT_NEAR(ratio->published, 9.703 / 2.3942, 1e-12);
}

TEST(PublishedRatio, ASeedWithoutErrorsIsLeftOutOfTheMedian) {
  auto results = sample_reconstruction();
  results.rows[1].seeds[1].errors = {};
  const auto ratio = published_ratio(results.rows);
  ASSERT_TRUE(ratio);
  EXPECT_THAT(ratio->ratio.values[1], IsNan());
  EXPECT_DOUBLE_EQ(ratio->ratio.median, 4);
}

TEST(PublishedRatio, NeedsTwoPublishedRows) {
  auto results = sample_reconstruction();
  results.rows[1].published.reset();
  EXPECT_FALSE(published_ratio(results.rows));
  EXPECT_FALSE(published_ratio({}));
}

TEST(SpeedNeeded, IsAFactorWhereTheScriptDoesNotWalk) {
  auto needed = *sample_reconstruction().speed_needed;
  EXPECT_THAT(speed_sentence(needed), HasSubstr("No speed of the subject up to 2.40 m/s gives"));
  EXPECT_THAT(speed_sentence(needed), HasSubstr("it is 9.50 cm there"));
  needed.speed_m_per_s = 2.25;
  EXPECT_THAT(speed_sentence(needed), HasSubstr("at 2.25 m/s (1.20 m/s: 7.00 ["));
  for (auto& point : needed.points) point.speed_m_per_s = 0;
  needed.speed_m_per_s = 0;
  needed.published_mean_cm = 8.25;  // half way from 7 to 9.5
  EXPECT_THAT(speed_sentence(needed), HasSubstr("1.50 times as fast"));
  needed.published_mean_cm = 1;
  EXPECT_THAT(speed_sentence(needed), HasSubstr("At 1 times the stated one the error is 7.00 cm "
                                                "already"));
  EXPECT_EQ(speed_factor_for(needed.points, 1), 1);
}

}  // namespace
}  // namespace simbench::reports
