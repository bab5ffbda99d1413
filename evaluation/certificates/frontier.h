// The points through which one part of a recording ties to the other: the past of a cut to its
// future.
//
// A chain of facts that crosses the cut does so along a clock, from its last point before the cut
// to its first one after, or along a fact with one end on either side. Those points, and the
// distances between them on each side, are all that a side need know of the other.
//
// FrontierWalk takes the points of a FactOrder from its begin, or from its end, and has at any time
// the frontier of what it took. save() and restore() let a walk go back.
//
//   Distances at_the_middle(const FactOrder& order) {
//     FrontierWalk past(order, FrontierWalk::kForward), future(order, FrontierWalk::kBackward);
//     const std::size_t points = order.points().size();
//     while (past.taken() < points / 2) past.take_next();
//     while (past.taken() + future.taken() < points) future.take_next();
//     return join(order, past.frontier(), future.frontier());
//   }
//
// Complexity, for n points of a frontier (the clocks and the open facts): a point O(n), or O(n^2)
// where a fact tells something new; frontier() O(n^2), join() O(n^3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/certificates/clock_graph.h"
#include "evaluation/certificates/fact_order.h"

namespace simbench::evaluation {

// Square, [from][to]; what is at least kFar is unbounded.
class Distances {
 public:
  static constexpr std::int64_t kFar = ClockGraph::kUnbounded.count() / 2;

  explicit Distances(std::size_t size)
      : size_(size), values_(size * size, ClockGraph::kUnbounded.count()) {}

  std::size_t size() const { return size_; }
  std::int64_t* operator[](std::size_t from) { return values_.data() + from * size_; }
  const std::int64_t* operator[](std::size_t from) const { return values_.data() + from * size_; }
  // All shortest paths in place. Differences below -kFar count as -kFar if they `may_be_long`
  // (ClockGraph::is_long()).
  void close(bool may_be_long);

 private:
  template <bool kMayBeLong>
  void close_all();

  std::size_t size_;
  std::vector<std::int64_t> values_;
};

struct Frontier {
  // Which point: the newest of a clock, or an end of an open fact.
  struct Place {
    bool is_fact = false;
    std::uint32_t number = 0;  // of the clock, or of the fact
    Nanoseconds local{};
    ClockGraph::Point point{};  // in the walk's graph
  };

  std::vector<Place> places;
  Distances distances{0};
  bool is_long = false;  // ClockGraph::is_long()
};

class FrontierWalk {
 public:
  // More instants matter at once only where nothing orders the clocks, or stamps are far off; the
  // work would grow with the square of their number.
  static constexpr std::size_t kMostLive = 4000;
  enum class Direction : std::uint8_t { kForward, kBackward };
  static constexpr Direction kForward = Direction::kForward;
  static constexpr Direction kBackward = Direction::kBackward;

  FrontierWalk(const FactOrder& order, Direction direction);

  // Takes the next point, which is next(). The fact that contradicts what is known, if any; then
  // the walk is over. Throws NotCertifiable beyond kMostLive.
  std::optional<std::uint32_t> take_next();
  std::size_t next() const { return next_; }
  std::size_t taken() const { return taken_; }

  ClockGraph& graph() { return graph_; }
  const ClockGraph& graph() const { return graph_; }
  Frontier frontier() const;

  struct Saved;
  Saved save() const;
  void restore(const Saved& saved);

 private:
  struct Open {
    std::uint32_t fact;
    ClockGraph::Point point;
  };

  std::optional<std::uint32_t> close_fact(std::uint32_t fact, ClockGraph::Point here);

  const FactOrder& order_;
  Direction direction_;
  std::size_t taken_ = 0;
  std::size_t next_ = 0;
  ClockGraph graph_;
  std::vector<Open> open_;
  std::vector<std::uint32_t> place_in_open_;  // by fact
};

struct FrontierWalk::Saved {
  std::size_t taken = 0;
  std::size_t next = 0;
  ClockGraph graph;
  std::vector<Open> open;
};

// The distances between the points of `past`, over all facts of both sides and across the cut.
Distances join(const FactOrder& order, const Frontier& past, const Frontier& future);

}  // namespace simbench::evaluation
