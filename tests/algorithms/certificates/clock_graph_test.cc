#include "algorithms/certificates/clock_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace simbench {
namespace {

using Point = ClockGraph::Point;

Picoseconds ps(std::int64_t count) { return Picoseconds(count); }

TEST(RateBound, RoundsOutward) {
  const RateBound quartz(50);
  EXPECT_EQ(quartz.most(from_ms(1000)), ps(1'000'050'002'501));  // 1e12 / (1 - 50e-6), up
  EXPECT_EQ(quartz.least(from_ms(1000)), ps(999'950'002'499));   // 1e12 / (1 + 50e-6), down
  EXPECT_EQ(quartz.most(from_ms(-1000)), ps(-999'950'002'499));
  EXPECT_EQ(quartz.least(from_ms(-1000)), ps(-1'000'050'002'501));
  EXPECT_EQ(quartz.most(Nanoseconds(0)), ps(0));
  EXPECT_EQ(RateBound(0).most(Nanoseconds(7)), ps(7000));
  EXPECT_DOUBLE_EQ(quartz.ppm(), 50.0);
  // 12 ppm fast, within 2: it counts a second in 0.999986 to 0.999990 s and a little.
  const RateBound measured(12, 2);
  EXPECT_NEAR(to_ms(measured.most(from_ms(1000))), 1000 / (1 + 10e-6), 1e-9);
  EXPECT_NEAR(to_ms(measured.least(from_ms(1000))), 1000 / (1 + 14e-6), 1e-9);
  EXPECT_DOUBLE_EQ(measured.ppm(), 2.0);
}

// A clock that may stand still, or race, bounds nothing.
TEST(RateBound, AnyRateIsTaken) {
  for (const double ppm : {1e6, 5e6, 1e300}) {
    const RateBound loose(ppm);
    EXPECT_EQ(loose.most(from_ms(10'000)), RateBound::kLongest) << ppm;
    EXPECT_GE(loose.least(from_ms(10'000)), ps(0)) << ppm;
    EXPECT_LE(loose.least(from_ms(10'000)), ps(10'000'000'000'000)) << ppm;
    ClockGraph graph({loose, RateBound(0)});
    const Point host = graph.advance(1, Nanoseconds(0));
    const Point before = graph.advance(0, Nanoseconds(0));
    graph.keep(before);
    ASSERT_TRUE(graph.bound(host, before, ps(0)));
    EXPECT_FALSE(ClockGraph::is_bounded(graph.most(host, graph.advance(0, from_ms(10'000)))));
  }
  // Backwards, which no clock goes: as slow as can be.
  EXPECT_EQ(RateBound(-3e6, 10).most(from_ms(10'000)), RateBound::kLongest);
}

TEST(RateBound, LongIntervalsAreNotBounded) {
  const RateBound quartz(50);
  EXPECT_EQ(quartz.most(Nanoseconds::max()), RateBound::kLongest);
  EXPECT_EQ(quartz.least(Nanoseconds::max()), RateBound::kLongest);
  EXPECT_EQ(quartz.most(Nanoseconds(-Nanoseconds::max().count())), -RateBound::kLongest);
}

// A perfect host asks a camera, which answers: the reading lies within the round trip.
TEST(ClockGraph, ARoundTripBoundsAReading) {
  ClockGraph graph({RateBound(0), RateBound(0)});
  const Point asked = graph.advance(0, from_us(100));
  graph.keep(asked);
  const Point read = graph.advance(1, from_us(7000));
  graph.keep(read);
  EXPECT_TRUE(graph.bound(read, asked, ps(0)));
  EXPECT_EQ(graph.most(asked, read), ClockGraph::kUnbounded);
  const Point answered = graph.advance(0, from_us(400));
  EXPECT_TRUE(graph.bound(answered, read, ps(0)));
  EXPECT_EQ(graph.most(asked, read), ps(300'000'000));
  EXPECT_EQ(graph.most(read, asked), ps(0));
  EXPECT_EQ(graph.most(read, answered), ps(300'000'000));
}

// What was known drifts away at the sum of both rates.
TEST(ClockGraph, WhatWasKnownDriftsAway) {
  ClockGraph graph({RateBound(50), RateBound(50)});
  Point host = graph.advance(0, from_ms(0));
  Point camera = graph.advance(1, from_ms(0));
  EXPECT_TRUE(graph.bound(host, camera, ps(0)));
  EXPECT_TRUE(graph.bound(camera, host, ps(0)));
  host = graph.advance(0, from_ms(10'000));
  camera = graph.advance(1, from_ms(10'000));
  EXPECT_NEAR(to_ms(graph.most(host, camera)), 1.0, 1e-6);
  EXPECT_NEAR(to_ms(graph.most(camera, host)), 1.0, 1e-6);
}

TEST(ClockGraph, AContradictionIsSaidAndLeavesTheGraph) {
  ClockGraph graph({RateBound(50), RateBound(50)});
  const Point a = graph.advance(0, from_ms(0));
  const Point b = graph.advance(1, from_ms(0));
  EXPECT_TRUE(graph.bound(a, b, ps(5)));
  EXPECT_FALSE(graph.bound(b, a, ps(-6)));
  EXPECT_EQ(graph.most(b, a), ClockGraph::kUnbounded);
  EXPECT_TRUE(graph.bound(b, a, ps(-5)));
  EXPECT_EQ(graph.most(b, a), ps(-5));
}

TEST(ClockGraph, OnlyTheNewestAndTheKeptAreLive) {
  ClockGraph graph({RateBound(50)});
  const Point kept = graph.advance(0, from_ms(1));
  graph.keep(kept);
  for (int i = 2; i < 100; ++i) graph.advance(0, from_ms(i));
  EXPECT_EQ(graph.live().size(), 2U);
  EXPECT_EQ(graph.local_of(graph.newest(0)), from_ms(99));
  EXPECT_NEAR(to_ms(graph.most(kept, graph.newest(0))), 98.0 / (1 - 50e-6), 1e-6);
  graph.release(kept);
  EXPECT_EQ(graph.live(), std::vector<Point>{graph.newest(0)});
}

// A random history of clocks with true rates, and all shortest paths over all of its points.
struct History {
  struct Fact {
    std::size_t from = 0, to = 0;
    std::int64_t most = 0;
  };
  std::vector<std::size_t> clock;
  std::vector<Nanoseconds> local;
  std::vector<Fact> facts;  // the later point is the one that closes it
};

History history_of(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const std::size_t clocks = 2 + random() % 4;
  std::vector<double> rate(clocks);
  for (double& r : rate) r = 1 + (below(1001) - 500) * 1e-7;  // within +-50 ppm
  History history;
  std::vector<double> at_ns;  // true
  double now_ns = 0;
  for (int i = 0; i < 40; ++i) {
    now_ns += below(3'000'000);
    const std::size_t clock = random() % clocks;
    history.clock.push_back(clock);
    history.local.push_back(Nanoseconds(static_cast<std::int64_t>(now_ns * rate[clock])));
    at_ns.push_back(now_ns);
    const std::size_t here = history.clock.size() - 1;
    for (std::size_t other = 0; other < here; ++other) {
      if (below(12) != 0) continue;
      const auto slack_ps = static_cast<std::int64_t>(below(400)) * 1000 + 4000;
      const auto truth_ps = static_cast<std::int64_t>((at_ns[here] - at_ns[other]) * 1000);
      if (below(2) == 0)
        history.facts.push_back({other, here, truth_ps + slack_ps});
      else
        history.facts.push_back({here, other, -truth_ps + slack_ps});
    }
  }
  return history;
}

using Matrix = std::vector<std::vector<std::int64_t>>;

Matrix all_paths(const History& history, std::size_t count) {
  const RateBound rate(50);
  constexpr std::int64_t kFar = std::int64_t{1} << 60;
  Matrix d(count, std::vector<std::int64_t>(count, kFar));
  for (std::size_t i = 0; i < count; ++i) {
    d[i][i] = 0;
    for (std::size_t j = i; j-- > 0;) {
      if (history.clock[i] != history.clock[j]) continue;
      const Nanoseconds step = history.local[i] - history.local[j];
      d[j][i] = rate.most(step).count();
      d[i][j] = -rate.least(step).count();
      break;
    }
  }
  for (const History::Fact& fact : history.facts) {
    if (fact.from < count && fact.to < count) {
      d[fact.from][fact.to] = std::min(d[fact.from][fact.to], fact.most);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
    }
  }
  return d;
}

// Without the sums that contain a fact that there is not.
std::int64_t capped(std::int64_t distance) {
  return distance >= std::int64_t{1} << 59 ? ClockGraph::kUnbounded.count() : distance;
}

// All points kept: every distance is the shortest path's, after each point.
TEST(ClockGraph, DistancesAreAllShortestPaths) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const History history = history_of(seed);
    ClockGraph graph(std::vector<RateBound>(6, RateBound(50)));
    std::vector<Point> points;
    for (std::size_t i = 0; i < history.clock.size(); ++i) {
      points.push_back(graph.advance(history.clock[i], history.local[i]));
      graph.keep(points.back());
      for (const History::Fact& fact : history.facts) {
        if (std::max(fact.from, fact.to) != i) continue;
        ASSERT_TRUE(graph.bound(points[fact.from], points[fact.to], ps(fact.most)));
      }
      if (i % 13 != 12 && i + 1 != history.clock.size()) continue;
      const Matrix d = all_paths(history, i + 1);
      for (std::size_t a = 0; a <= i; ++a) {
        for (std::size_t b = 0; b <= i; ++b) {
          const std::int64_t most =
              std::min(graph.most(points[a], points[b]).count(), std::int64_t{1} << 60);
          ASSERT_EQ(capped(most), capped(d[a][b])) << seed << ' ' << a << ' ' << b;
        }
      }
    }
  }
}

// Points that are let go lose nothing: distances between the kept ones stay exact.
TEST(ClockGraph, LettingPointsGoLosesNothing) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const History history = history_of(seed);
    const std::size_t count = history.clock.size();
    std::vector<std::size_t> to_come(count, 0);
    for (const History::Fact& fact : history.facts) ++to_come[std::min(fact.from, fact.to)];
    ClockGraph graph(std::vector<RateBound>(6, RateBound(50)));
    std::vector<Point> points(count);
    std::size_t most_live = 0;
    for (std::size_t i = 0; i < count; ++i) {
      points[i] = graph.advance(history.clock[i], history.local[i]);
      for (std::size_t n = 0; n < to_come[i]; ++n) graph.keep(points[i]);
      if (i % 10 == 0) graph.keep(points[i]);  // asked for at the end
      for (const History::Fact& fact : history.facts) {
        if (std::max(fact.from, fact.to) != i) continue;
        ASSERT_TRUE(graph.bound(points[fact.from], points[fact.to], ps(fact.most)));
        graph.release(points[std::min(fact.from, fact.to)]);
      }
      most_live = std::max(most_live, graph.live().size());
    }
    const Matrix d = all_paths(history, count);
    for (std::size_t a = 0; a < count; a += 10) {
      for (std::size_t b = 0; b < count; b += 10) {
        ASSERT_EQ(capped(graph.most(points[a], points[b]).count()), capped(d[a][b]));
      }
    }
    EXPECT_LT(most_live, count);
  }
}

// The bound is tight: the instants d(a, .) are a world in which every fact holds and b is as late
// after a as the graph says it may be.
TEST(ClockGraph, AWorldAttainsEveryBound) {
  const RateBound rate(50);
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const History history = history_of(seed);
    const std::size_t count = history.clock.size();
    const Matrix d = all_paths(history, count);
    for (const History::Fact& fact : history.facts) {
      EXPECT_LE(d[0][fact.to] - d[0][fact.from], fact.most);
    }
    std::vector<std::optional<std::size_t>> last(6);
    for (std::size_t i = 0; i < count; ++i) {
      const std::optional<std::size_t> before = std::exchange(last[history.clock[i]], i);
      if (!before || d[0][i] >= std::int64_t{1} << 59) continue;
      const Nanoseconds step = history.local[i] - history.local[*before];
      EXPECT_LE(d[0][i] - d[0][*before], rate.most(step).count());
      EXPECT_GE(d[0][i] - d[0][*before], rate.least(step).count());
    }
  }
}

}  // namespace
}  // namespace simbench
