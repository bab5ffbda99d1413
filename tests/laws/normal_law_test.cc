#include "laws/normal_law.h"

#include <gtest/gtest.h>

namespace simbench {
namespace {

TEST(NormalProbability, OfKnownScores) {
  EXPECT_EQ(normal_probability(0), 0.5);
  EXPECT_NEAR(normal_probability(1.959963985), 0.975, 1e-9);
  EXPECT_NEAR(normal_probability(-1.959963985), 0.025, 1e-9);
}

TEST(NormalDensity, IsTheSlopeOfTheProbability) {
  EXPECT_NEAR(normal_density(0), 0.3989422804014327, 1e-15);
  for (const double z : {-3.0, -0.5, 0.0, 1.0, 2.5}) {
    const double slope = (normal_probability(z + 1e-5) - normal_probability(z - 1e-5)) / 2e-5;
    EXPECT_NEAR(normal_density(z), slope, 1e-9) << z;
  }
}

}  // namespace
}  // namespace simbench
