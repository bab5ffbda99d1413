#include "algorithms/host_sync/huygens/coded_probes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "laws/lower_hull.h"

namespace simbench {
namespace {

TEST(CodedProbesTest, APairIsPureIfItsSpacingIsKept) {
  CodedProbes probes(Nanoseconds(50));
  const auto spread_by = [&probes](std::uint32_t pair, std::int64_t spread_ns) {
    probes.arrive(pair, 0, 10'000);
    probes.arrive(pair, 1, 20'000 + spread_ns);
    return probes.departed(pair, {0, 10'000});
  };
  const auto pure = spread_by(1, 50);
  ASSERT_TRUE(pure);
  EXPECT_EQ((*pure)[0].left_ns, 0);
  EXPECT_EQ((*pure)[0].arrived_ns, 10'000);
  EXPECT_EQ((*pure)[1].left_ns, 10'000);
  EXPECT_EQ((*pure)[1].arrived_ns, 20'050);
  EXPECT_TRUE(spread_by(2, -50));
  EXPECT_FALSE(spread_by(3, 51));
  EXPECT_FALSE(spread_by(4, -51));
}

TEST(CodedProbesTest, IncompletePairsCopiesAndOldPairsGiveNothing) {
  CodedProbes probes(Nanoseconds(50));
  EXPECT_FALSE(probes.departed(1, {0, 100})) << "unknown";
  probes.arrive(1, 1, 1'100);
  EXPECT_FALSE(probes.departed(1, {0, 100})) << "one was lost";
  probes.arrive(2, 0, 2'000);
  probes.arrive(2, 0, 9'000);
  probes.arrive(2, 1, 2'100);
  EXPECT_TRUE(probes.departed(2, {0, 100})) << "the copy came later";
  EXPECT_FALSE(probes.departed(2, {0, 100})) << "given once";
  probes.arrive(4, 1, 4'100);
  probes.arrive(3, 0, 3'000);
  probes.arrive(4, 0, 4'000);
  probes.arrive(3, 1, 3'100);
  EXPECT_TRUE(probes.departed(3, {0, 100})) << "reordered";
  EXPECT_TRUE(probes.departed(4, {0, 100}));
  for (std::uint32_t pair = 5; pair < 5 + 2 * CodedProbes::kOpenPairs; ++pair) {
    probes.arrive(pair, 0, pair * 1'000);
    probes.arrive(pair, 1, pair * 1'000 + 100);
  }
  EXPECT_FALSE(probes.departed(5, {0, 100})) << "no longer kept";
  EXPECT_TRUE(probes.departed(4 + 2 * CodedProbes::kOpenPairs, {0, 100}));
}

TEST(CodedProbesTest, ASenderThatBeginsAnewIsHeard) {
  CodedProbes probes(Nanoseconds(50));
  probes.arrive(1'000, 0, 0);
  probes.arrive(1, 0, 1'000);
  probes.arrive(1, 1, 1'100);
  EXPECT_TRUE(probes.departed(1, {0, 100}));
}

// The line of the points given, and the width of its corridor.
struct Clouds {
  LowerHull above;
  LowerHull below_negated;
  std::vector<LinePoint> above_points;
  std::vector<LinePoint> below_points;

  void add_above(std::int64_t x, std::int64_t y) {
    above_points.push_back({x, y});
    above.add({x, y});
  }
  void add_below(std::int64_t x, std::int64_t y) {
    below_points.push_back({x, y});
    below_negated.add({x, -y});
  }
  std::optional<PairLine> line(std::int64_t x, double max_rate = 1) const {
    return separating_line(above.vertices(), below_negated.vertices(), x, max_rate);
  }
  double width(double rate) const {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const LinePoint& point : above_points) {
      least = std::min(least, static_cast<double>(point.y) - rate * static_cast<double>(point.x));
    }
    for (const LinePoint& point : below_points) {
      most = std::max(most, static_cast<double>(point.y) - rate * static_cast<double>(point.x));
    }
    return least - most;
  }
};

TEST(SeparatingLineTest, IsTheMiddleOfTheWidestCorridor) {
  // Two parallel edges of slope 0.1, 20 apart.
  Clouds clouds;
  clouds.add_above(0, 110);
  clouds.add_above(50, 300);
  clouds.add_above(100, 120);
  clouds.add_below(20, 92);
  clouds.add_below(60, -500);
  clouds.add_below(80, 98);
  const PairLine line = *clouds.line(50);
  EXPECT_NEAR(line.rate, 0.1, 1e-12);
  EXPECT_EQ(line.x_ns, 50);
  EXPECT_EQ(line.lead_ns, 105);
  EXPECT_EQ(line.lead_at(150), 115);
}

TEST(SeparatingLineTest, NothingWithoutBothClouds) {
  Clouds clouds;
  EXPECT_FALSE(clouds.line(0));
  clouds.add_above(0, 1);
  EXPECT_FALSE(clouds.line(0));
  clouds.add_below(0, -1);
  EXPECT_EQ(clouds.line(0)->lead_ns, 0);
  EXPECT_EQ(clouds.line(0)->rate, 0);
}

TEST(SeparatingLineTest, TheRateIsLimitedWherePointsDoNotHoldIt) {
  Clouds rising;
  rising.add_above(0, 10);
  rising.add_below(100, -10);
  EXPECT_EQ(rising.line(0, 5e-4)->rate, 5e-4);
  Clouds falling;
  falling.add_above(100, 10);
  falling.add_below(0, -10);
  EXPECT_EQ(falling.line(0, 5e-4)->rate, -5e-4);
}

TEST(SeparatingLineTest, NoRateHasAWiderCorridor) {
  boost::random::mt19937_64 engine(5);
  boost::random::exponential_distribution<double> delay(1.0 / 3'000);
  for (int run = 0; run < 300; ++run) {
    Clouds clouds;
    const double rate = (static_cast<double>(engine() % 2'001) - 1'000) * 1e-8;
    // Some clouds overlap: their delays begin below zero.
    const double least = run % 3 == 0 ? -3'000 : 500;
    for (std::int64_t i = 0; i < 3 + static_cast<std::int64_t>(engine() % 100); ++i) {
      const std::int64_t x = i * 20'000'000 + static_cast<std::int64_t>(engine() % 1'000'000);
      const double truth = rate * static_cast<double>(x);
      clouds.add_above(x, std::llround(truth + least + delay(engine)));
      clouds.add_below(x + 5'000'000, std::llround(truth + 5e6 * rate - least - delay(engine)));
    }
    const PairLine line = *clouds.line(0, 5e-4);
    const double width = clouds.width(line.rate);
    for (const double change : {-1e-5, -1e-7, -1e-9, 1e-9, 1e-7, 1e-5}) {
      EXPECT_GE(width + 1e-3, clouds.width(line.rate + change)) << "seed 5, run " << run;
    }
  }
}

TEST(SeparatingLineTest, FindsOffsetAndRateOfExponentialDelaysAsWellAsTheirMinimaAllow) {
  // n delays of mean m each way: the corridor's middle errs by some m / n.
  boost::random::mt19937_64 engine(6);
  constexpr double kMean = 10'000;
  boost::random::exponential_distribution<double> delay(1.0 / kMean);
  double squares = 0;
  constexpr int kRuns = 200;
  constexpr std::int64_t kPoints = 100;
  for (int run = 0; run < kRuns; ++run) {
    Clouds clouds;
    for (std::int64_t i = 0; i < kPoints; ++i) {
      clouds.add_above(i * 20'000'000, std::llround(7'000 + 4'000 + delay(engine)));
      clouds.add_below(i * 20'000'000 + 9, std::llround(7'000 - 4'000 - delay(engine)));
    }
    const double error =
        static_cast<double>(clouds.line(kPoints * 10'000'000, 5e-4)->lead_ns - 7'000);
    squares += error * error;
  }
  EXPECT_LT(std::sqrt(squares / kRuns), 3 * kMean / kPoints);
}

}  // namespace
}  // namespace simbench
