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
  const EvenSeries even = evenly_spaced(LogPoints{points_at({10, 10.5, 11, 11.5})}, {});
  EXPECT_EQ(even.series.interval_s, 0.5);
  ASSERT_THAT(even.series.pieces, SizeIs(1));
  EXPECT_EQ(even.series.pieces[0].start_s, 0);
  EXPECT_THAT(even.series.pieces[0].x_s, ElementsAre(10e-3, 10.5e-3, 11e-3, 11.5e-3));
  EXPECT_EQ(even.left_out, 0);
  EXPECT_EQ(even.longest_gap_s, 0);
}

TEST(EvenlySpaced, JitterStaysOnTheGridAndThatIsTheMean) {
  const EvenSeries even = evenly_spaced(LogPoints{points_at({0, 16, 33, 48, 65})}, {});
  EXPECT_THAT(even.series.pieces, SizeIs(1));
  EXPECT_EQ(even.series.interval_s, 16.25);
}

TEST(EvenlySpaced, GapsAndOtherIntervalsSeparatePieces) {
  const EvenSeries even =
      evenly_spaced(LogPoints{points_at({0, 1, 2, 5, 6, 6.5, 7, 8, 10, 12})}, {});
  EXPECT_EQ(even.series.interval_s, 1);
  EXPECT_EQ(even.left_out, 1) << "6.5";
  EXPECT_EQ(even.longest_gap_s, 3);
  ASSERT_THAT(even.series.pieces, SizeIs(4));
  EXPECT_THAT(even.series.pieces[0].x_s, ElementsAre(0, 1e-3, 2e-3));
  EXPECT_THAT(even.series.pieces[1].x_s, ElementsAre(5e-3, 6e-3, 7e-3, 8e-3));
  EXPECT_EQ(even.series.pieces[2].start_s, 10);
}

TEST(EvenlySpaced, AStatedIntervalDecimates) {
  const EvenSeries even = evenly_spaced(LogPoints{points_at({0, 1, 2, 3, 4, 6, 8})}, 2);
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
              ElementsAre("a.log: 1 point between those 1 s apart only in the time error",
                          "a.log: 2 gaps, the longest of 14 s: no difference reaches over a gap",
                          "a.log: 1 point without a neighbour at 1 s only in the time error; "
                          "--interval-s states another interval"));
  EXPECT_FALSE(found.frequency_offset);
}

TEST(LogStability, EveryPointCountsInTheTimeError) {
  ClockLog log = log_at({0, 1, 2, 3, 4, 5});
  for (ClockLogPoint& point : log.points) point.error_s = 1e-9;
  log.points.insert(log.points.begin() + 3, {Microseconds(2'500'000), 5e-3});
  const LogStability found = stability_of_log(log, {});
  EXPECT_EQ(found.samples, 7);
  EXPECT_EQ(found.stability.points, 6);
  EXPECT_EQ(found.stability.time_error.max_te_ms, 5);
  EXPECT_NEAR(found.stability.time_error.dynamic_te_p2p_ms, 5 - 1e-6, 1e-12);
  EXPECT_EQ(found.stability.mtie_ms[0].value, 0);
}

TEST(LogStability, PointsOfOneTimeAreTheirMean) {
  ClockLog log = log_at({0, 1, 2, 2, 4, 5});
  log.points[2].error_s = 1e-3;
  log.points[3].error_s = 5e-3;
  const LogStability found = stability_of_log(log, {});
  EXPECT_EQ(found.samples, 6);
  EXPECT_EQ(found.stability.points, 5);
  EXPECT_NEAR(found.stability.mtie_ms[0].value, 2, 1e-12) << "from 1 to the mean, 3 ms";
  EXPECT_THAT(found.notes, testing::Contains("a.log: 1 point of the time of the one before: the "
                                             "mean is taken"));
}

TEST(LogStability, ARestartIsAGap) {
  ClockLog log = log_at({100, 101, 102, 0, 1, 2});
  log.segments = {3};
  const LogStability found = stability_of_log(log, {});
  EXPECT_EQ(found.stability.points, 6);
  EXPECT_EQ(found.stability.pieces, 2);
  EXPECT_EQ(found.stability.interval_s, 1);
  EXPECT_THAT(found.notes, ElementsAre("a.log: 1 gap: no difference reaches over a gap"));
}

TEST(LogStability, ARestartTakesOneIntervalForTheFrequencyAndForTimes) {
  ClockLog log = log_at({100, 101, 102, 0, 1, 2});
  log.segments = {3};
  for (std::size_t i = 0; i < log.points.size(); ++i) {
    log.points[i].error_s = 1e-6 * static_cast<double>(i);
  }
  const LogStability removed = stability_of_log(log, {.remove_frequency = true});
  EXPECT_NEAR(removed.frequency_offset.value_or(0), 1e-6, 1e-15);
  EXPECT_NEAR(removed.stability.time_error.dynamic_te_p2p_ms, 0, 1e-12);
  const LogStability later = stability_of_log(log, {.from = LogTime{2, true}});
  EXPECT_EQ(later.samples, 4) << "102, and behind the restart";
  EXPECT_EQ(later.stability.pieces, 2);
}

TEST(LogStability, JitterOfThirtyPercentIsTakenAsEven) {
  std::vector<double> times;
  double at_s = 0;
  for (int i = 0; i < 200; ++i) times.push_back(at_s += 0.7 + 0.6 * (i * 7919 % 100) / 100.0);
  const LogStability found = stability_of_log(log_at(times), {});
  EXPECT_EQ(found.stability.points, 200);
  EXPECT_EQ(found.stability.pieces, 1);
  EXPECT_NEAR(found.stability.interval_s, (times.back() - times.front()) / 199, 1e-6);
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("distances of points vary")));
}

TEST(LogStability, APollThatGrowsIsTakenWhereItCoversTheLog) {
  std::vector<double> times;
  double at_s = 0;
  for (const double poll_s : {64.0, 128.0, 256.0, 512.0, 1024.0}) {
    for (int i = 0; i < 20; ++i) times.push_back(at_s += poll_s);
  }
  const LogStability found = stability_of_log(log_at(times), {});
  EXPECT_NEAR(found.stability.interval_s, 1024, 16);
  EXPECT_EQ(found.samples, 100);
  EXPECT_GT(found.stability.points, 30) << "of 39680 s";
  EXPECT_THAT(found.notes.front(), HasSubstr("from 64 to 1024 s: taken at 10"));
}

TEST(LogStability, FindsTheStartOfAClockThatWasNotSet) {
  ClockLog log{.path = "a.log", .format = "ptp4l"};
  for (int i = 0; i < 100; ++i) {
    const double error_s = i < 3 ? 37.0 - i : 1e-9 * (i * 7919 % 101 - 50);
    log.points.push_back({Microseconds(1'000'000 * i), error_s});
  }
  const LogStability found = stability_of_log(log, {});
  ASSERT_TRUE(found.start);
  EXPECT_EQ(found.start->points, 3);
  EXPECT_EQ(found.start->until_s, 3);
  EXPECT_EQ(found.start->largest_ms, 37000);
  EXPECT_EQ(found.stability.time_error.max_te_ms, 37000);
  EXPECT_NEAR(found.start->settled.max_te_ms, 50e-6, 1e-12);
  EXPECT_FALSE(found.settled);
  const LogStability settled = stability_of_log(log, {.settle = true});
  EXPECT_TRUE(settled.settled);
  EXPECT_EQ(settled.samples, 97);
  EXPECT_NEAR(settled.stability.time_error.max_te_ms, 50e-6, 1e-12);
  EXPECT_FALSE(stability_of_log(log_at({0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                        12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}),
                                {})
                   .start)
      << "a drift has no start";
}

TEST(LogStability, TakesTheAskedTime) {
  const ClockLog log = log_at({100, 101, 102, 103, 104, 105});
  const LogStability part =
      stability_of_log(log, {.from = LogTime{1, true}, .until = LogTime{104, false}});
  EXPECT_EQ(part.samples, 4);
  EXPECT_EQ(part.first_s, 101);
  EXPECT_THROW(stability_of_log(log, {.from = LogTime{7, true}}), scenarios::InputError);
}

TEST(LogStability, OfSummariesTheLargestAndTheRmsExist) {
  const ClockLog log{.path = "a.log",
                     .format = "ptp4l",
                     .points = {{Microseconds(0), 3e-9}, {Microseconds(1'000'000), 4e-9}},
                     .largest_s = {5e-9, 9e-9}};
  const LogStability found = stability_of_log(log, {});
  EXPECT_TRUE(found.are_summaries);
  EXPECT_DOUBLE_EQ(found.stability.time_error.max_te_ms, 9e-6);
  EXPECT_DOUBLE_EQ(found.stability.time_error.rms_te_ms, 1e-6 * std::sqrt(12.5));
  EXPECT_THAT(found.stability.adev, IsEmpty());
  EXPECT_THAT(found.notes,
              ElementsAre(HasSubstr("summary_interval does not exceed logSyncInterval")));
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
    EXPECT_STREQ(error.what(),
                 "a.log: found a single time error, allowed: two or more of different times");
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
