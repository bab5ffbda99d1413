#include "laws/line_fit.h"

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>

namespace simbench {
namespace {

TEST(LineSums, GoesThroughTwoPoints) {
  LineSums sums(2);
  sums.add({.x = 0, .y = 5});
  sums.add({.x = 10, .y = 7});
  EXPECT_EQ(sums.line().slope, 0.2);
  EXPECT_EQ(sums.line().at(20), 9.0);
  EXPECT_EQ(sums.line().at(-25), 0.0);
}

TEST(LineSums, LeastSquaresOfFourPoints) {
  // Textbook: (1,6) (2,5) (3,7) (4,10) give y = 3.5 + 1.4 x.
  LineSums sums(4);
  const std::int64_t ys[] = {6, 5, 7, 10};
  for (std::int64_t i = 0; i < 4; ++i) sums.add({.x = i + 1, .y = ys[i]});
  EXPECT_DOUBLE_EQ(sums.line().slope, 1.4);
  EXPECT_DOUBLE_EQ(sums.line().at(0), 3.5);
}

TEST(LineSums, MeanWhereNoSlopeIsDetermined) {
  LineSums sums(3);
  EXPECT_EQ(sums.line().at(1234), 0.0);
  sums.add({.x = 7, .y = 10});
  EXPECT_EQ(sums.line().at(1000), 10.0);
  sums.add({.x = 7, .y = 20});
  EXPECT_EQ(sums.line().slope, 0.0);
  EXPECT_EQ(sums.line().at(-1000), 15.0);
}

// A century from the anchor, neighbouring points: doubles see one x, exact sums see the slope.
TEST(LineSums, KeepsTheSlopeFarFromTheAnchor) {
  constexpr std::int64_t kCenturyUs = 100LL * 365 * 86'400 * 1'000'000;
  LineSums sums(30);
  for (std::int64_t i = 0; i < 30; ++i) sums.add({.x = kCenturyUs + i, .y = 3 * i + 1});
  EXPECT_EQ(sums.line().slope, 3.0);
  EXPECT_EQ(sums.line().at(kCenturyUs), 1.0);
}

TEST(LineSums, AnyInputGivesAFiniteLine) {
  constexpr std::int64_t kLow = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kHigh = std::numeric_limits<std::int64_t>::max();
  const LinePoint points[] = {{kLow, kHigh}, {kHigh, kLow}, {kHigh, kHigh}, {0, kLow}, {1, 1}};
  LineWindow window(3);
  for (int round = 0; round < 3; ++round) {
    for (const LinePoint& point : points) {
      window.push(point);
      EXPECT_TRUE(std::isfinite(window.line().at(point.x)));
      EXPECT_TRUE(std::isfinite(window.line().at(point.y / 2)));
    }
  }
}

TEST(LineWindow, APointThatLeavesLeavesNoTrace) {
  LineWindow window(2);
  LineWindow fresh(2);
  window.push({.x = 7'777'777'777'777, .y = 987'654'321});
  for (LineWindow* w : {&window, &fresh}) {
    w->push({.x = 1'000'000'000'000, .y = 333'333'333});
    w->push({.x = 1'000'000'000'001, .y = -333'333'334});
  }
  EXPECT_EQ(window.line().slope, fresh.line().slope);
  EXPECT_EQ(window.line().slope, -666'666'667.0);
}

// Near the anchor, centuries from it, at the limits of what is exact, and between these.
TEST(LineWindow, EqualsFreshSumsOfTheLastPoints) {
  constexpr std::uint32_t kSeed = 11;
  boost::random::mt19937 random(kSeed);
  LineWindow window(7);
  std::deque<LinePoint> last;
  for (int i = 0; i < 5000; ++i) {
    const int bits = 10 + 10 * (i / 40 % 6);
    boost::random::uniform_int_distribution<std::int64_t> value(-(std::int64_t{1} << bits),
                                                                std::int64_t{1} << bits);
    const std::int64_t base = i / 100 % 2 == 0 ? 0 : std::int64_t{1} << 57;
    last.push_back({base + value(random), value(random)});
    if (i % 1000 < 20) last.back() = {i % 2 == 0 ? INT64_MAX : INT64_MIN, INT64_MAX};
    if (last.size() > 7) last.pop_front();
    window.push(last.back());
    LineSums fresh(7);
    for (const LinePoint& point : last) fresh.add(point);
    ASSERT_EQ(window.line().slope, fresh.line().slope) << "point " << i << ", seed " << kSeed;
    ASSERT_EQ(window.line().at(42), fresh.line().at(42)) << "point " << i << ", seed " << kSeed;
  }
}

}  // namespace
}  // namespace simbench
