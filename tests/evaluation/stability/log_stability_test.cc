#include "evaluation/stability/log_stability.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<ClockLogPoint> points_at(const std::vector<double>& times_s) {
  std::vector<ClockLogPoint> points;
  points.reserve(times_s.size());
  for (const double time_s : times_s) {
    points.push_back({Microseconds(std::llround(1e6 * time_s)), 1e-3 * time_s});
  }
  return points;
}

ClockLog log_at(const std::vector<double>& times_s) {
  return {.path = "a.log", .format = "csv", .points = points_at(times_s)};
}

TEST(EvenlySpaced, ARegularLogIsOnePiece) {
  const EvenSeries even = evenly_spaced(points_at({10, 10.5, 11, 11.5}), {});
  EXPECT_EQ(even.series.interval_s, 0.5);
  ASSERT_THAT(even.series.pieces, SizeIs(1));
  EXPECT_EQ(even.series.pieces[0].start_s, 0);
  EXPECT_THAT(even.series.pieces[0].x_s, ElementsAre(10e-3, 10.5e-3, 11e-3, 11.5e-3));
  EXPECT_EQ(even.left_out, 0);
  EXPECT_EQ(even.longest_gap_s, 0);
}

TEST(EvenlySpaced, JitterStaysOnTheGridAndThatIsTheMean) {
  const EvenSeries even = evenly_spaced(points_at({0, 16, 33, 48, 65}), {});
  EXPECT_THAT(even.series.pieces, SizeIs(1));
  EXPECT_EQ(even.series.interval_s, 16.25);
}

TEST(EvenlySpaced, GapsAndOtherIntervalsSeparatePieces) {
  const EvenSeries even = evenly_spaced(points_at({0, 1, 2, 5, 6, 6.5, 7, 8, 10, 12}), {});
  EXPECT_EQ(even.series.interval_s, 1);
  EXPECT_EQ(even.left_out, 1) << "6.5";
  EXPECT_EQ(even.longest_gap_s, 3);
  ASSERT_THAT(even.series.pieces, SizeIs(4));
  EXPECT_THAT(even.series.pieces[0].x_s, ElementsAre(0, 1e-3, 2e-3));
  EXPECT_THAT(even.series.pieces[1].x_s, ElementsAre(5e-3, 6e-3, 7e-3, 8e-3));
  EXPECT_EQ(even.series.pieces[2].start_s, 10);
}

TEST(EvenlySpaced, AStatedIntervalDecimates) {
  const EvenSeries even = evenly_spaced(points_at({0, 1, 2, 3, 4, 6, 8}), 2);
  EXPECT_EQ(even.series.interval_s, 2);
  EXPECT_EQ(even.left_out, 2);
  ASSERT_THAT(even.series.pieces, SizeIs(1));
  EXPECT_THAT(even.series.pieces[0].x_s, SizeIs(5));
}

TEST(LogStability, SaysWhatItLeavesOut) {
  const LogStability found = stability_of_log(log_at({100, 101, 102, 105, 106, 106.5, 120}), {});
  EXPECT_EQ(found.first_s, 100);
  EXPECT_EQ(found.stability.points, 6);
  EXPECT_EQ(found.stability.pieces, 3);
  EXPECT_THAT(found.notes,
              ElementsAre("a.log: 1 point between those 1 s apart left out",
                          "a.log: 2 gaps, the longest of 14 s: no difference reaches over a gap",
                          "a.log: 1 point without a neighbour at 1 s only in the time error; "
                          "--interval-s states another interval"));
  EXPECT_FALSE(found.frequency_offset);
}

TEST(LogStability, RemovesTheFrequencyOnRequest) {
  const LogStability found =
      stability_of_log(log_at({0, 1, 2, 3, 10, 11, 12}), {.remove_frequency = true});
  ASSERT_TRUE(found.frequency_offset);
  EXPECT_NEAR(*found.frequency_offset, 1e-3, 1e-15);
  EXPECT_NEAR(found.stability.time_error.dynamic_te_ms, 0, 1e-12);
}

TEST(LogStability, FewPointsHaveNoDeviationAndOneIsRefused) {
  const LogStability two = stability_of_log(log_at({0, 1}), {});
  EXPECT_THAT(two.stability.adev, IsEmpty());
  EXPECT_THAT(two.stability.mtie_ms, SizeIs(1));
  EXPECT_THAT(two.notes, ElementsAre(HasSubstr("no three points 1 s apart")));
  try {
    stability_of_log(log_at({0}), {});
    FAIL() << "a single point";
  } catch (const scenarios::InputError& error) {
    EXPECT_STREQ(error.what(), "a.log: found a single time error, allowed: two or more");
  }
}

TEST(LogStability, HasNoNanWhateverTheTimes) {
  for (const auto& times :
       {std::vector<double>{-4e11, 4e11}, {0, 1e-6, 2e-6}, {0, 1e-6, 1, 1e9, 1e9 + 1e-3}}) {
    const LogStability found = stability_of_log(log_at(times), {.remove_frequency = true});
    EXPECT_TRUE(std::isfinite(found.stability.interval_s));
    EXPECT_GT(found.stability.interval_s, 0);
    for (const auto* curve : {&found.stability.adev, &found.stability.mtie_ms}) {
      for (const StabilityPoint& point : *curve) EXPECT_TRUE(std::isfinite(point.value));
    }
    EXPECT_TRUE(std::isfinite(found.stability.time_error.rms_te_ms));
  }
}

}  // namespace
}  // namespace simbench::evaluation
