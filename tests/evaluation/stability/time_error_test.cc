#include "evaluation/stability/time_error.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/evaluation/stability/noises.h"

namespace simbench::evaluation {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

TimeErrorSeries one_piece(std::vector<double> x_s, double interval_s = 1) {
  return {.interval_s = interval_s, .pieces = {{.start_s = 100, .x_s = std::move(x_s)}}};
}

TEST(TimeErrorSummary, IsThatOfTheHandCalculatedSeries) {
  TimeErrorSeries series = one_piece({1e-3, 3e-3});
  series.pieces.push_back({.start_s = 200, .x_s = {-7e-3, 7e-3}});
  const TimeErrorSummary summary = time_error_of(series);
  EXPECT_DOUBLE_EQ(summary.max_te_ms, 7);
  EXPECT_DOUBLE_EQ(summary.rms_te_ms, std::sqrt(108.0 / 4));
  EXPECT_DOUBLE_EQ(summary.constant_te_ms, 1);
  EXPECT_DOUBLE_EQ(summary.dynamic_te_ms, std::sqrt(104.0 / 4));
  EXPECT_DOUBLE_EQ(summary.dynamic_te_p2p_ms, 14);
  EXPECT_EQ(time_error_of({}).rms_te_ms, 0);
}

TEST(TimeErrorSummary, KeepsSmallNoiseOnALargeOffset) {
  std::vector<double> x(100'000, 1e6);
  for (std::size_t i = 0; i < x.size(); i += 2) x[i] += std::ldexp(1, -20);
  const TimeErrorSummary summary = time_error_of(one_piece(x));
  EXPECT_NEAR(summary.dynamic_te_ms, 1e3 * std::ldexp(1, -21), 1e-12);
}

TEST(TimeErrorSummary, PercentilesAreThoseOfAllMagnitudes) {
  // The magnitudes 0 to 1000 us, in two pieces, with both signs.
  TimeErrorSeries series{.interval_s = 1, .pieces = {{.start_s = 0}, {.start_s = 5000}}};
  for (int i = 1000; i >= 0; --i) {
    series.pieces[i < 300 ? 0 : 1].x_s.push_back((i % 2 == 0 ? 1e-6 : -1e-6) * i);
  }
  const TimeErrorSummary summary = time_error_of(series);
  EXPECT_NEAR(summary.p50_te_ms, 0.5, 1e-12);
  EXPECT_NEAR(summary.p95_te_ms, 0.95, 1e-12);
  EXPECT_NEAR(summary.p99_te_ms, 0.99, 1e-12);
  EXPECT_NEAR(summary.p99_9_te_ms, 0.999, 1e-12);
  EXPECT_NEAR(summary.dynamic_te_p2p_ms, 1 + 0.999, 1e-12);
  EXPECT_EQ(time_error_of({}).p99_te_ms, 0);
}

TEST(ShareWithin, CountsAllPoints) {
  TimeErrorSeries series = one_piece({1e-6, -2e-6, 3e-6});
  series.pieces.push_back({.start_s = 200, .x_s = {-4e-6}});
  EXPECT_EQ(share_within(series, 0.5e-6), 0);
  EXPECT_EQ(share_within(series, 2e-6), 0.5) << "the limit itself is within";
  EXPECT_EQ(share_within(series, 1), 1);
  EXPECT_EQ(share_within({}, 1), std::nullopt);
}

TEST(FrequencyOffset, OfALineIsItsSlopeAndItsMeanStays) {
  TimeErrorSeries series{.interval_s = 0.5};
  // Two pieces of one line, far from the zero of time.
  for (const double start_s : {1e6, 1e6 + 100}) {
    TimeErrorPiece& piece = series.pieces.emplace_back(TimeErrorPiece{.start_s = start_s});
    for (int i = 0; i < 20; ++i) {
      piece.x_s.push_back(1e-3 + 2e-6 * (start_s - 1e6 + 0.5 * i));
    }
  }
  const double mean_ms = time_error_of(series).constant_te_ms;
  const auto slope = remove_frequency_offset(series);
  ASSERT_TRUE(slope);
  EXPECT_NEAR(*slope, 2e-6, 1e-15);
  EXPECT_NEAR(time_error_of(series).constant_te_ms, mean_ms, 1e-12);
  EXPECT_NEAR(time_error_of(series).dynamic_te_ms, 0, 1e-9);
}

TEST(FrequencyOffset, NeedsTwoPoints) {
  TimeErrorSeries one = one_piece({1});
  EXPECT_FALSE(remove_frequency_offset(one));
  EXPECT_EQ(one.pieces[0].x_s[0], 1);
  TimeErrorSeries two = one_piece({1, 3}, 4);
  EXPECT_EQ(remove_frequency_offset(two), 0.5);
  EXPECT_EQ(two.pieces[0].x_s[0], 2);
}

TEST(Steps, AreFoundInNoiseAndNamed) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    std::vector<double> x = white_noise(seed, 500, 1e-6);
    for (std::size_t i = 200; i < x.size(); ++i) x[i] += 5e-5;
    for (std::size_t i = 400; i < x.size(); ++i) x[i] -= 1e-3;
    const auto steps = steps_of(one_piece(x, 2));
    ASSERT_THAT(steps, SizeIs(2)) << "seed " << seed;
    EXPECT_EQ(steps[0].at_s, 100 + 2 * 200);
    EXPECT_NEAR(steps[0].step_s, 5e-5, 1e-5);
    EXPECT_EQ(steps[1].at_s, 100 + 2 * 400);
    EXPECT_NEAR(steps[1].step_s, -1e-3, 1e-5);
  }
}

TEST(Steps, NoiseDriftAndOutliersAreNone) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    std::vector<double> x = white_noise(seed, 2000, 1e-6);
    double walk = 0;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = walk += x[i] + 1e-3;
    EXPECT_THAT(steps_of(one_piece(x)), IsEmpty()) << "seed " << seed;
    std::vector<double> outliers = white_noise(seed, 2000, 1e-6);
    outliers[700] += 1e-3;
    outliers[1200] -= 1e-2;
    EXPECT_THAT(steps_of(one_piece(outliers)), IsEmpty()) << "seed " << seed;
  }
}

TEST(Steps, AStepBehindAnOutlierIsFound) {
  std::vector<double> x = white_noise(3, 100, 1e-6);
  x[50] += 1e-2;
  for (std::size_t i = 51; i < x.size(); ++i) x[i] -= 5e-3;
  const auto steps = steps_of(one_piece(x));
  ASSERT_THAT(steps, SizeIs(1));
  EXPECT_EQ(steps[0].at_s, 151);
  EXPECT_NEAR(steps[0].step_s, -5e-3, 1e-5);
}

TEST(Steps, OfAConstantOrALineAreNoneButItsJumpIs) {
  std::vector<double> constant(100, 0.25);
  EXPECT_THAT(steps_of(one_piece(constant)), IsEmpty());
  for (std::size_t i = 30; i < constant.size(); ++i) constant[i] = 0.5;
  const auto steps = steps_of(one_piece(constant));
  ASSERT_THAT(steps, SizeIs(1));
  EXPECT_EQ(steps[0].at_s, 130);
  EXPECT_EQ(steps[0].step_s, 0.25);
  std::vector<double> line;
  line.reserve(1000);
  for (int i = 0; i < 1000; ++i) line.push_back(0.1 * i - 50);
  EXPECT_THAT(steps_of(one_piece(line)), IsEmpty());
}

TEST(Steps, AreNotSoughtInFewPointsOrOverGaps) {
  EXPECT_THAT(steps_of({}), IsEmpty());
  EXPECT_THAT(steps_of(one_piece({0, 0, 1, 1, 1})), IsEmpty());
  TimeErrorSeries series = one_piece(white_noise(1, 100, 1e-6));
  series.pieces.push_back({.start_s = 300, .x_s = white_noise(2, 100, 1e-6)});
  for (double& x : series.pieces[1].x_s) x += 1;
  EXPECT_THAT(steps_of(series), IsEmpty());
}

}  // namespace
}  // namespace simbench::evaluation
