#include "sim/engine/normal_process.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sim/at_ms.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kProcess("test: process");
constexpr int kSeeds = 4000;

// Means over seeds of z(a) z(b).
double covariance(double a_ms, double b_ms) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    NormalProcess process(seed, kProcess, 3, from_ms(100));
    sum += process.at(at_ms(a_ms)) * process.at(at_ms(b_ms));
  }
  return sum / kSeeds;
}

TEST(NormalProcess, HasTheSameVarianceEverywhere) {
  for (const double at : {-250.0, 0.0, 13.0, 50.0, 99.0, 12'345.0}) {
    EXPECT_NEAR(covariance(at, at), 1, 5 * std::sqrt(2.0 / kSeeds)) << at << " ms, seeds 1-4000";
  }
}

TEST(NormalProcess, IsForgottenAfterTwoSteps) {
  EXPECT_GT(covariance(10, 11), 0.9);
  EXPECT_NEAR(covariance(0, 50), std::cos(std::numbers::pi / 4), 5 / std::sqrt(1.0 * kSeeds));
  EXPECT_NEAR(covariance(10, 211), 0, 5 / std::sqrt(1.0 * kSeeds));
}

TEST(NormalProcess, ReadingsDoNotDependOnTheirOrder) {
  NormalProcess forward(7, kProcess, 0, from_ms(10));
  NormalProcess backward(7, kProcess, 0, from_ms(10));
  std::vector<double> values;
  values.reserve(100);
  for (int i = 0; i < 100; ++i) values.push_back(forward.at(at_ms(3.7 * i)));
  for (int i = 100; i-- > 0;) {
    EXPECT_EQ(backward.at(at_ms(3.7 * i)), values[static_cast<std::size_t>(i)]) << i;
  }
}

TEST(NormalProcess, NumbersTellProcessesApart) {
  NormalProcess one(7, kProcess, 0, from_ms(10));
  NormalProcess other(7, kProcess, 1, from_ms(10));
  EXPECT_NE(one.at(at_ms(1)), other.at(at_ms(1)));
}

}  // namespace
}  // namespace simbench::sim
