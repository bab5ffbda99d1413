#include "reconstruction/paint.h"

#include <gtest/gtest.h>

#include <limits>

namespace simbench::reconstruction {
namespace {

float lightness(const Eigen::Vector3f& colour) {
  return colour.dot(Eigen::Vector3f(0.3F, 0.6F, 0.1F));
}

TEST(ErrorColour, GetsLighterWithTheErrorAndThenStays) {
  for (int step = 1; step <= 10; ++step) {
    EXPECT_GT(lightness(error_colour(kPaintedUpTo * step / 10)),
              lightness(error_colour(kPaintedUpTo * (step - 1) / 10)))
        << step;
  }
  EXPECT_EQ(error_colour(kPaintedUpTo), error_colour(5 * kPaintedUpTo));
}

TEST(ErrorColour, OfNoErrorIsGreyAndOfEveryErrorIsNot) {
  const Eigen::Vector3f grey = error_colour(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(grey.x(), grey.y());
  EXPECT_EQ(grey.y(), grey.z());
  for (int step = 0; step <= 20; ++step) {
    const Eigen::Vector3f colour = error_colour(kPaintedUpTo * step / 20);
    EXPECT_GT(colour.maxCoeff() - colour.minCoeff(), 0.2F) << step;
    EXPECT_GE(colour.minCoeff(), 0.0F);
    EXPECT_LE(colour.maxCoeff(), 1.0F);
  }
}

TEST(ErrorColours, AreThoseOfTheMeanErrors) {
  VertexErrors errors(2);
  errors.sum_m[0] = 0.08;
  errors.matches[0] = 2;
  const auto colours = error_colours(errors);
  ASSERT_EQ(colours.size(), 2U);
  EXPECT_EQ(colours[0], error_colour(0.04));
  EXPECT_EQ(colours[1], error_colour(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace simbench::reconstruction
