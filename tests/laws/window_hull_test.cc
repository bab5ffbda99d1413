#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "laws/lower_hull.h"

namespace simbench {
namespace {

std::string text_of(std::span<const LinePoint> points) {
  std::string text;
  for (const LinePoint point : points) {
    text.append("(").append(std::to_string(point.x)).append(",");
    text.append(std::to_string(point.y)).append(")");
  }
  return text;
}

// The hull of what is in the queue, from nothing.
std::string expected(const std::deque<LinePoint>& points) {
  LowerHull hull;
  for (const LinePoint point : points) hull.add(point);
  return text_of(hull.vertices());
}

TEST(WindowHull, OnePoint) {
  WindowHull window(1);
  EXPECT_TRUE(window.empty());
  window.push({1, 5});
  EXPECT_TRUE(window.full());
  EXPECT_EQ(window.oldest().y, 5);
  window.pop();
  EXPECT_TRUE(window.empty());
  window.push({2, 6});
  EXPECT_EQ(text_of(window.hull()), "(2,6)");
}

TEST(WindowHull, TakingOutAVertexUncoversWhatItHid) {
  WindowHull window(5);
  for (const LinePoint point : std::vector<LinePoint>{{0, 0}, {1, 9}, {2, 8}, {3, 9}, {4, 9}}) {
    window.push(point);
  }
  EXPECT_EQ(text_of(window.hull()), "(0,0)(4,9)");
  window.pop();
  EXPECT_EQ(text_of(window.hull()), "(1,9)(2,8)(4,9)");
  window.push({5, 0});
  EXPECT_EQ(text_of(window.hull()), "(1,9)(5,0)");
}

TEST(WindowHull, AgreesWithARecomputedHull) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    boost::random::mt19937 random(seed);
    const auto capacity = static_cast<std::size_t>(1 + seed % 40);
    boost::random::uniform_int_distribution<std::int64_t> step(1, 5);
    boost::random::uniform_int_distribution<std::int64_t> value(0, seed % 3 == 0 ? 5 : 100'000);
    boost::random::uniform_int_distribution<int> one_in_ten(0, 9);
    WindowHull window(capacity);
    std::deque<LinePoint> points;
    std::int64_t x = 0;
    for (int i = 0; i < 400; ++i) {
      while (!points.empty() && (points.size() == capacity || one_in_ten(random) == 0)) {
        window.pop();
        points.pop_front();
      }
      points.push_back({x += step(random), value(random)});
      window.push(points.back());
      ASSERT_EQ(window.size(), points.size());
      ASSERT_EQ(window.oldest().x, points.front().x);
      ASSERT_EQ(text_of(window.hull()), expected(points)) << "seed " << seed << ", step " << i;
      if (i == 200) {
        window.clear();
        points.clear();
      }
    }
  }
}

TEST(WindowHull, WindowsOf300OfConvexAndConcaveData) {
  for (const std::int64_t sign : {1, -1}) {
    WindowHull window(300);
    std::deque<LinePoint> points;
    for (std::int64_t x = 0; x < 1000; ++x) {
      if (window.full()) {
        window.pop();
        points.pop_front();
      }
      points.push_back({x, sign * x * x});
      window.push(points.back());
      if (x % 7 != 0) continue;
      ASSERT_EQ(text_of(window.hull()), expected(points)) << sign << ", " << x;
    }
  }
}

}  // namespace
}  // namespace simbench
