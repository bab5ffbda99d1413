#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_01.hpp>
#include <vector>

#include "laws/lower_hull.h"

namespace simbench {
namespace {

TEST(EnvelopeTest, KeepsTheCornersBelowAndDropsWhatIsAbove) {
  Envelope envelope(100);
  envelope.add(0, 0);
  envelope.add(1, 5);
  envelope.add(2, 1);
  envelope.add(3, 1.6);
  envelope.add(4, 4);
  const std::vector<Envelope::Point>& hull = envelope.vertices();
  ASSERT_EQ(hull.size(), 4u);
  EXPECT_EQ(hull[1].x, 2);
  EXPECT_EQ(hull[2].x, 3);
  EXPECT_DOUBLE_EQ(*envelope.at(1), 0.5);
  EXPECT_DOUBLE_EQ(*envelope.at(3.5), 2.8);
  EXPECT_EQ(*envelope.at(4), 4);
  EXPECT_FALSE(envelope.at(4.5));
  EXPECT_FALSE(envelope.at(-0.5));
  EXPECT_EQ(envelope.span(), 4);
}

TEST(EnvelopeTest, OfPointsAtOneXTheLowestCounts) {
  Envelope envelope(100);
  envelope.add(1, 3);
  envelope.add(1, 2);
  envelope.add(1, 4);
  ASSERT_EQ(envelope.vertices().size(), 1u);
  EXPECT_EQ(envelope.at(1), 2);
  EXPECT_EQ(envelope.span(), 0);
}

TEST(EnvelopeTest, AnXThatGoesBackIsTakenAsTheLastOne) {
  Envelope envelope(100);
  envelope.add(5, 3);
  envelope.add(4, 1);
  EXPECT_EQ(envelope.at(5), 1);
  EXPECT_FALSE(envelope.at(4));
}

TEST(EnvelopeTest, TouchIsTheMinimumOverAllPointsForAnySlope) {
  boost::random::mt19937_64 engine(7);
  boost::random::uniform_01<double> uniform;
  for (int run = 0; run < 50; ++run) {
    Envelope envelope(1e9);
    std::vector<Envelope::Point> points;
    for (int i = 0; i < 100; ++i) {
      points.push_back({static_cast<double>(i), 10 * uniform(engine)});
      envelope.add(points.back().x, points.back().y);
    }
    for (double slope = -3; slope <= 3; slope += 0.13) {
      double least = 1e9;
      for (const auto& point : points) least = std::min(least, point.y - slope * point.x);
      const Envelope::Point touched = envelope.touch(slope);
      EXPECT_DOUBLE_EQ(touched.y - slope * touched.x, least) << "run " << run;
    }
  }
}

TEST(EnvelopeTest, ForgetsWhatIsOlderThanTheWindowWithinOnePart) {
  Envelope envelope(80);
  envelope.add(0, -100);
  for (int x = 1; x <= 80; ++x) envelope.add(x, 0);
  EXPECT_EQ(envelope.touch(0).y, -100);
  for (int x = 81; x <= 91; ++x) envelope.add(x, 0);
  EXPECT_EQ(envelope.touch(0).y, 0);
  EXPECT_GE(envelope.span(), 80 - 10);
}

TEST(EnvelopeTest, MemoryIsBoundedEvenWhereEveryPointIsACorner) {
  Envelope envelope(1e9);
  for (int x = 0; x < 100'000; ++x) envelope.add(x, 1e-3 * x * static_cast<double>(x));
  EXPECT_LE(envelope.vertices().size(), (Envelope::kParts + 1) * Envelope::kPartVertices);
}

TEST(EnvelopeTest, ClearedItIsEmpty) {
  Envelope envelope(10);
  EXPECT_TRUE(envelope.empty());
  EXPECT_EQ(envelope.span(), 0);
  EXPECT_FALSE(envelope.at(0));
  envelope.add(1, 1);
  envelope.clear();
  EXPECT_TRUE(envelope.empty());
  EXPECT_FALSE(envelope.at(1));
}

}  // namespace
}  // namespace simbench
