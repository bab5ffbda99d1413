// The exact interval of every difference of instants, from clocks with bounded rates and messages.
//
// Problem: two cameras expose, each stamps with its own clock, and the only ties between the clocks
// are messages whose delays nobody knows. Which differences of the two instants are possible?
// Adding up the errors of estimates (half of a round trip here, a drift there) gives a bound that
// is either unsure or too wide, as every message bounds every clock a little.
//
// Known is: a clock's rate error is bounded (rate_bound.h), and nothing arrives before it is sent.
// Each fact bounds a difference of two points, t(to) - t(from) <= most, where a point is the
// instant at which a clock counted a number. A chain of facts adds up; the least sum over all
// chains is the exact bound: a shortest path in the synchronisation graph. No algorithm can know
// more.
//
// A capture has hundreds of thousands of points, of which few matter at a time: to the future a
// clock's past is its newest point, and the distances from it. The graph keeps the distances
// between live points only: the newest of each clock, and those that the caller keeps because a
// fact about them is still to come (a message under way, a frame whose set is open).
//
//   ClockGraph graph({RateBound(50), RateBound(50)});   // a host, a camera
//   const auto asked = graph.advance(0, from_ms(10));   // the host counts 10 ms
//   graph.keep(asked);
//   const auto seen = graph.advance(1, from_ms(700));   // the camera reads 700 ms
//   graph.bound(seen, asked, Picoseconds(0));           // it was asked before
//   graph.release(asked);
//   Picoseconds later = graph.most(asked, seen);        // kUnbounded: no answer came yet
//
// Points of a clock come in order: upwards, or, where a recording is read from its end, downwards.
// A contradiction, a chain of facts that ends before it began, is detected by the fact that closes
// it: bound() returns false and leaves the graph as it was.
//
// Exact: integers of picoseconds, rates rounded outward once a point. Complexity, for n live
// points: advance() O(n); bound() O(1) for a fact that tells nothing new, else O(n^2); most() O(1).
// Memory O(n^2). Span: 20 days. Source: Patt-Shamir and Rajsbaum, STOC 1994; Ostrovsky and
// Patt-Shamir, "Optimal and efficient clock synchronization under drifting clocks", PODC 1999 (live
// points).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithms/certificates/rate_bound.h"
#include "algorithms/ports/time.h"

namespace simbench {

class ClockGraph {
 public:
  // A live point. Its number may be used again once the point is live no longer.
  using Point = std::uint32_t;

  // No chain of facts bounds the difference.
  static constexpr Picoseconds kUnbounded{std::int64_t{1} << 62};

  // Sums with kUnbounded may be somewhat less than it.
  static constexpr bool is_bounded(Picoseconds most) { return most < kUnbounded / 2; }

  explicit ClockGraph(std::vector<RateBound> clocks);

  std::size_t clocks() const { return newest_.size(); }
  const RateBound& rate_of(std::size_t clock) const { return rates_[clock]; }

  // The instant at which `clock` counted `local`. It becomes the clock's newest point; the former
  // one is live no longer unless it is kept.
  Point advance(std::size_t clock, Nanoseconds local);
  // The newest point of a clock; it must have one.
  Point newest(std::size_t clock) const;
  bool has_begun(std::size_t clock) const { return newest_[clock] != kNone; }

  // A kept point stays live until it is released as often.
  void keep(Point point);
  void release(Point point);

  // The fact t(to) - t(from) <= most. False if it contradicts the others.
  bool bound(Point from, Point to, Picoseconds most);
  // The least upper bound of t(to) - t(from); its negation bounds t(from) - t(to) from below.
  Picoseconds most(Point from, Point to) const { return Picoseconds(row(from)[to]); }

  // Whether differences may be so far below 0 that sums of them would not fit 64 bits. Then they
  // count as less far, as an upper bound may; it is the case only of some weeks, or of stamps that
  // are broken.
  bool is_long() const { return reach_ >= kFar / 2; }

  // In no order.
  const std::vector<Point>& live() const { return live_; }
  Nanoseconds local_of(Point point) const { return places_[point].local; }
  std::size_t clock_of(Point point) const { return places_[point].clock; }

 private:
  static constexpr Point kNone = ~Point{0};
  // What is at least this far is unbounded: sums with it may be somewhat less than kUnbounded.
  static constexpr std::int64_t kFar = kUnbounded.count() / 2;
  static_assert(RateBound::kLongest.count() == kFar);

  struct Place {
    std::uint32_t clock = 0;
    std::uint32_t kept = 0;
    Nanoseconds local{};
  };

  std::int64_t* row(Point point) { return distances_.data() + std::size_t{point} * stride_; }
  const std::int64_t* row(Point point) const {
    return distances_.data() + std::size_t{point} * stride_;
  }
  template <bool kIsLong>
  void shorten(Point from, Point to, std::int64_t fact);
  void go_further(std::int64_t way) { reach_ += std::clamp(way, std::int64_t{0}, kFar - reach_); }
  Point take_place();
  void grow();
  void remove(Point point);

  std::vector<RateBound> rates_;
  std::vector<Point> newest_;  // by clock
  std::vector<Place> places_;
  std::vector<Point> free_;
  std::vector<Point> live_;
  std::vector<std::uint32_t> place_in_live_;
  std::size_t stride_ = 0;
  std::int64_t reach_ = 0;               // no difference is further below 0, ps
  std::vector<std::int64_t> distances_;  // [from][to], ps; of a free place without a meaning
};

}  // namespace simbench
