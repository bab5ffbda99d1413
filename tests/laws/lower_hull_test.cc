#include "laws/lower_hull.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cstdint>
#include <limits>
#include <vector>

namespace simbench {
namespace {

std::vector<LinePoint> vertices_of(const std::vector<LinePoint>& points) {
  LowerHull hull;
  for (const LinePoint point : points) hull.add(point);
  return {hull.vertices().begin(), hull.vertices().end()};
}

std::vector<std::int64_t> xs_of(const std::vector<LinePoint>& points) {
  std::vector<std::int64_t> xs;
  xs.reserve(points.size());
  for (const LinePoint point : points) xs.push_back(point.x);
  return xs;
}

using Xs = std::vector<std::int64_t>;

TEST(LowerHull, KeepsWhatIsBelow) {
  EXPECT_EQ(xs_of(vertices_of({{0, 3}, {2, 9}, {4, 5}})), (Xs{0, 4}));
  EXPECT_EQ(xs_of(vertices_of({{0, 3}, {2, 1}, {4, 5}})), (Xs{0, 2, 4}));
  EXPECT_EQ(xs_of(vertices_of({{0, 0}, {1, 1}, {2, 2}, {3, 3}})), (Xs{0, 3})) << "on an edge";
  EXPECT_EQ(xs_of(vertices_of({{0, 0}, {1, 0}, {2, 1}, {3, 3}, {4, -9}})), (Xs{0, 4}));
}

TEST(LowerHull, LineOfOnePointIsLevel) {
  const std::vector<LinePoint> one = {{5, 7}};
  EXPECT_EQ(middle_line(one).at(1000), 7);
  EXPECT_EQ(middle_line(one).slope, 0);
}

TEST(LowerHull, LineIsTheEdgeOverTheMiddle) {
  const std::vector<LinePoint> vertices = {{0, 10}, {2, 0}, {6, 0}, {8, 10}};
  EXPECT_EQ(middle_line(vertices).slope, 0);
  EXPECT_EQ(support_line(vertices, 0).slope, -5);
  EXPECT_EQ(support_line(vertices, 4).slope, -5) << "at a vertex, the earlier edge";
  EXPECT_EQ(support_line(vertices, 5).slope, 0);
  EXPECT_EQ(support_line(vertices, 13).slope, 5);
  EXPECT_EQ(support_line(vertices, 99).slope, 5);
}

// Known defect of a reference implementation: its middle goes stale when the hull falls back to two
// points, and it returns a slope of 0.9 and 6.6 at x = 8. (In tenths.)
TEST(LowerHull, CollapseToTwoPointsGivesTheTrueSlope) {
  LowerHull hull;
  for (const LinePoint point : std::vector<LinePoint>{
           {0, 0}, {10, 5}, {20, 12}, {30, 21}, {40, 32}, {50, 45}, {60, 60}, {70, -50}}) {
    hull.add(point);
  }
  ASSERT_EQ(hull.vertices().size(), 2U);
  const SupportLine line = middle_line(hull.vertices());
  EXPECT_NEAR(line.slope, -0.714286, 1e-6);
  EXPECT_DOUBLE_EQ(line.at(80), -50 - 50.0 / 7);
}

TEST(LowerHull, SteepLinesGiveWayToThoseOfTheLargestSlope) {
  const std::vector<LinePoint> vertices = {{0, 100}, {10, 0}, {20, 20}, {30, 100}};
  // Over the middle, 15: the edge 10..20 of slope 2.
  EXPECT_EQ(middle_line(vertices, 3).slope, 2);
  EXPECT_EQ(middle_line(vertices, 1).slope, 1);
  EXPECT_EQ(middle_line(vertices, 1).at(10), 0) << "touches the hull";
  EXPECT_EQ(support_line(vertices, 2, 1).slope, -1);
  EXPECT_EQ(support_line(vertices, 2, 1).at(10), 0);
  EXPECT_EQ(support_line(vertices, 58, 1).at(10), 0);
  EXPECT_EQ(support_line(vertices, 58, 4).at(20), 20);
}

TEST(LowerHull, IsExactAtTheEndsOfItsReach) {
  constexpr std::int64_t kEnd = std::int64_t{1} << 61;
  // One unit below the line between points 2^62 apart.
  EXPECT_EQ(xs_of(vertices_of({{-kEnd, -kEnd}, {0, -1}, {kEnd, kEnd}})), (Xs{-kEnd, 0, kEnd}));
  EXPECT_EQ(xs_of(vertices_of({{-kEnd, -kEnd}, {0, 0}, {kEnd, kEnd}})), (Xs{-kEnd, kEnd}));
}

TEST(LowerHull, EndlessConvexDataIsThinned) {
  LowerHull hull;
  constexpr std::int64_t kPoints = 20'000;
  for (std::int64_t x = 0; x < kPoints; ++x) {
    hull.add({x, x * x});
    ASSERT_LE(hull.vertices().size(), LowerHull::kMaxVertices);
  }
  EXPECT_EQ(hull.vertices().front().x, 0);
  EXPECT_EQ(hull.vertices().back().x, kPoints - 1);
  // A tangent of the parabola, but for the vertices left out: a chord of k is k^2 / 4 above,
  // and k is 20,000 / 2048 and a bit.
  const std::int64_t middle = kPoints / 2;
  EXPECT_NEAR(middle_line(hull.vertices()).at(middle), static_cast<double>(middle * middle), 36);
  for (std::size_t i = 2; i < hull.vertices().size(); ++i) {
    EXPECT_TRUE(is_vertex(hull.vertices()[i - 2], hull.vertices()[i - 1], hull.vertices()[i]));
  }
}

// b is a vertex unless it lies on or above a line between two others (or is an end).
std::vector<LinePoint> brute_force(const std::vector<LinePoint>& points) {
  std::vector<LinePoint> vertices;
  for (std::size_t b = 0; b < points.size(); ++b) {
    bool above = false;
    for (std::size_t a = 0; a < b; ++a) {
      for (std::size_t c = b + 1; c < points.size(); ++c) {
        above = above || !is_vertex(points[a], points[b], points[c]);
      }
    }
    if (!above) vertices.push_back(points[b]);
  }
  return vertices;
}

TEST(LowerHull, AgreesWithBruteForce) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    boost::random::mt19937 random(seed);
    boost::random::uniform_int_distribution<std::int64_t> step(1, 3);
    // Few values, so that many points lie on one line.
    boost::random::uniform_int_distribution<std::int64_t> value(0, 6);
    std::vector<LinePoint> points;
    points.reserve(12);
    std::int64_t x = 0;
    for (int i = 0; i < 12; ++i) points.push_back({x += step(random), value(random)});
    const std::vector<LinePoint> vertices = vertices_of(points);
    ASSERT_EQ(xs_of(vertices), xs_of(brute_force(points))) << "seed " << seed;
    // The best value under all points at the middle, over all lines through two points.
    const std::int64_t twice_middle = points.front().x + points.back().x;
    const double middle = static_cast<double>(twice_middle) / 2;
    const SupportLine line = middle_line(vertices);
    const double found = static_cast<double>(line.touches.y) +
                         line.slope * (middle - static_cast<double>(line.touches.x));
    double least = std::numeric_limits<double>::infinity();
    for (const LinePoint a : points) {
      for (const LinePoint b : points) {
        if (a.x >= b.x || 2 * a.x > twice_middle || 2 * b.x < twice_middle) continue;
        const double slope = static_cast<double>(b.y - a.y) / static_cast<double>(b.x - a.x);
        least =
            std::min(least, static_cast<double>(a.y) + slope * (middle - static_cast<double>(a.x)));
      }
    }
    ASSERT_NEAR(found, least, 1e-9) << "seed " << seed;
    for (const LinePoint point : points) {
      ASSERT_LE(line.at(point.x), static_cast<double>(point.y) + 1e-9) << "seed " << seed;
    }
  }
}

TEST(LowerHullDeathTest, PointsComeInOrder) {
  LowerHull hull;
  hull.add({1, 0});
  EXPECT_DEATH(hull.add({1, 0}), "in order");
}

}  // namespace
}  // namespace simbench
