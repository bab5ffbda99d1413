#include "evaluation/scoring/asymmetry_floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <numbers>

namespace simbench::evaluation {
namespace {

TEST(AsymmetryFloor, OneSlaveIsTheMeanOfAHalfNormal) {
  const auto floor = asymmetry_floor(2.0, 2);
  ASSERT_TRUE(floor.has_value());
  EXPECT_NEAR(floor->amd_ms, std::sqrt(2 / std::numbers::pi), 1e-9);
  EXPECT_NEAR(floor->host_error_ms, std::sqrt(2 / std::numbers::pi), 1e-12);
}

TEST(AsymmetryFloor, ManySlavesAgreeWithDraws) {
  constexpr unsigned kSeed = 7;
  boost::random::mt19937_64 engine(kSeed);
  boost::random::normal_distribution<double> draw(0, 0.5);
  double sum = 0;
  constexpr int kRuns = 200'000;
  for (int run = 0; run < kRuns; ++run) {
    double low = 0;
    double high = 0;
    for (int slave = 0; slave < 5; ++slave) {
      const double error = draw(engine);
      low = std::min(low, error);
      high = std::max(high, error);
    }
    sum += high - low;
  }
  EXPECT_NEAR(asymmetry_floor(1.0, 6)->amd_ms, sum / kRuns, 0.005) << "seed " << kSeed;
}

TEST(AsymmetryFloor, NoneWithoutSlavesOrAsymmetry) {
  EXPECT_FALSE(asymmetry_floor(0, 6).has_value());
  EXPECT_FALSE(asymmetry_floor(0.01, 1).has_value());
}

}  // namespace
}  // namespace simbench::evaluation
