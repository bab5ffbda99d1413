#include "evaluation/stability/band_filter.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "tests/evaluation/stability/noises.h"

namespace simbench::evaluation {
namespace {

using testing::Each;
using testing::IsEmpty;
using testing::SizeIs;

// The amplitude that is left of a sine of amplitude 1.
double gain_at(double hertz, double interval_s, Band band) {
  std::vector<double> x;
  for (int i = 0; i < 20'000; ++i) {
    x.push_back(std::sin(2 * std::numbers::pi * hertz * interval_s * i));
  }
  const auto passed = filtered(series_of(std::move(x), interval_s), band);
  const std::vector<double>& y = passed->pieces.at(0).x_s;
  double squares = 0;
  for (const double value : y) squares += value * value;
  return std::sqrt(2 * squares / static_cast<double>(y.size()));
}

TEST(BandFilter, PassesHalfThePowerAtItsEdge) {
  for (const double interval_s : {0.0625, 0.3, 1.0, 2.3}) {
    EXPECT_NEAR(gain_at(0.1, interval_s, Band::kLow), std::sqrt(0.5), 2e-3) << interval_s;
    EXPECT_NEAR(gain_at(0.1, interval_s, Band::kHigh), std::sqrt(0.5), 2e-3) << interval_s;
  }
}

TEST(BandFilter, IsOfFirstOrder) {
  // At 0.06 s the warping of 1 Hz is 1 %.
  EXPECT_NEAR(gain_at(0.03, 0.06, Band::kLow), 1 / std::hypot(1, 0.3), 2e-3);
  EXPECT_NEAR(gain_at(1, 0.06, Band::kLow), 1 / std::hypot(1, 10), 2e-3);
  EXPECT_NEAR(gain_at(0.03, 0.06, Band::kHigh), 0.3 / std::hypot(1, 0.3), 2e-3);
  EXPECT_NEAR(gain_at(1, 0.06, Band::kHigh), 10 / std::hypot(1, 10), 2e-3);
}

TEST(BandFilter, AnOffsetIsAllLow) {
  const TimeErrorSeries series = series_of(std::vector<double>(100, 1e6 + 0.1));
  EXPECT_THAT(filtered(series, Band::kLow)->pieces.at(0).x_s, Each(1e6 + 0.1));
  EXPECT_THAT(filtered(series, Band::kHigh)->pieces.at(0).x_s, Each(0));
  EXPECT_EQ(filtered(series, Band::kAll)->pieces.at(0).x_s, series.pieces[0].x_s);
}

TEST(BandFilter, BandsAddUpToTheSeriesBehindTheSettling) {
  TimeErrorSeries series = series_of(white_noise(1, 50, 1e-6), 0.5);
  series.pieces.push_back({.start_s = 100, .x_s = white_noise(2, 40, 1e-6)});
  series.pieces.push_back({.start_s = 200, .x_s = white_noise(3, 16, 1e-6)});
  const auto low = filtered(series, Band::kLow);
  const auto high = filtered(series, Band::kHigh);
  ASSERT_THAT(low->pieces, SizeIs(2)) << "8 s are 16 points";
  EXPECT_EQ(low->interval_s, 0.5);
  EXPECT_EQ(low->pieces[0].start_s, 8);
  EXPECT_EQ(low->pieces[1].start_s, 108);
  for (std::size_t piece = 0; piece < 2; ++piece) {
    const std::vector<double>& x = series.pieces[piece].x_s;
    ASSERT_THAT(low->pieces[piece].x_s, SizeIs(x.size() - 16));
    for (std::size_t i = 0; i + 16 < x.size(); ++i) {
      EXPECT_NEAR(low->pieces[piece].x_s[i] + high->pieces[piece].x_s[i], x[i + 16], 1e-20);
    }
  }
}

TEST(BandFilter, NeedsPointsThatAreCloseEnough) {
  EXPECT_TRUE(filtered(series_of({1, 2}, 2.5), Band::kLow));
  EXPECT_FALSE(filtered(series_of({1, 2}, 2.6), Band::kHigh));
  EXPECT_THAT(filtered({}, Band::kLow)->pieces, IsEmpty());
}

}  // namespace
}  // namespace simbench::evaluation
