// A random phase that is sampled step by step on a fixed grid of true time, in both directions from
// true zero, where it is 0; between grid points it is linear.
//
// The caller's step function changes the state over one step of the grid and returns the phase's
// gain. It is called once for every step, outwards from zero, and must take its random numbers from
// the step's index alone: then values depend neither on the order of the queries nor on when the
// world starts.
//
// Units: nanoseconds. Complexity: O(1) once the steps between true zero and the query are sampled
// and while the queries stay near each other. Steps are kept where the queries are, some 64 KiB in
// each direction, and of all others the state at every 4096th, from which they are sampled anew:
// service of many hours on a fine grid needs time, not memory.
//
//   GridWalk<double> walk(step_ns, frequency_at_zero);
//   double ns = walk.phase_ns(t_ns, [&](double& frequency, std::int64_t index, double sign) {
//     return (frequency += sign * draw(index)) * step_ns;
//   });
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench::sim {

template <class State>
class GridWalk {
 public:
  GridWalk() = default;
  GridWalk(std::int64_t step_ns, const State& at_zero)
      : step_ns_(step_ns), forward_(at_zero), backward_(at_zero) {}

  std::int64_t step_ns() const { return step_ns_; }

  // `step(state, index, sign)` moves the state over the step that begins at grid point `index`,
  // forwards in time if sign is 1 and backwards if it is -1, and returns the phase's growth from
  // that grid point to the next.
  template <class Step>
  double phase_ns(std::int64_t since_zero_ns, const Step& step) const {
    if (!cell_.has(since_zero_ns, step_ns_)) look_up(floor_div(since_zero_ns, step_ns_), step);
    const double part =
        static_cast<double>(since_zero_ns - cell_.begin_ns) / static_cast<double>(step_ns_);
    return cell_.phase_ns + part * cell_.growth_ns;
  }

 private:
  static constexpr std::size_t kBlock = 4096;

  struct Point {
    double phase_ns = 0;
    State state{};
  };
  // One direction of time. phases_ns[i] belongs to the grid point at distance first + i.
  struct Side {
    Side() = default;
    explicit Side(const State& at_zero)
        : phases_ns{0.0}, state(at_zero), saved{Point{0.0, at_zero}} {}
    std::size_t first = 0;  // a multiple of kBlock
    std::vector<double> phases_ns;
    State state{};             // at the last of these points
    std::vector<Point> saved;  // every kBlock-th, as far as they were sampled
  };

  // The step of the grid that the last query met: most meet it again.
  struct Cell {
    bool has(std::int64_t t_ns, std::int64_t step_ns) const {
      return static_cast<std::uint64_t>(t_ns) - static_cast<std::uint64_t>(begin_ns) <
             static_cast<std::uint64_t>(step_ns);
    }
    std::int64_t begin_ns = std::numeric_limits<std::int64_t>::max();
    double phase_ns = 0;  // at its beginning
    double growth_ns = 0;
  };

  // Makes the step that begins at grid point `index` the cell at hand.
  template <class Step>
  void look_up(std::int64_t index, const Step& step) const {
    const bool forward = index >= 0;
    Side& side = forward ? forward_ : backward_;
    // The grid points around the step, by their distance from zero: `inner` and the next.
    const auto inner = static_cast<std::size_t>(forward ? index : -index - 1);
    std::size_t at = inner - side.first;
    // Also where `inner` lies before the first one kept.
    if (at >= side.phases_ns.size() - 1) at = reach(side, inner, forward, step);
    const double inner_ns = side.phases_ns[at];
    const double outer_ns = side.phases_ns[at + 1];
    cell_ = {.begin_ns = index * step_ns_,
             .phase_ns = forward ? inner_ns : outer_ns,
             .growth_ns = forward ? outer_ns - inner_ns : inner_ns - outer_ns};
  }

  // Samples the points at `inner` and the next; returns the place of `inner`. Out of the hot path.
  template <class Step>
  [[gnu::noinline]] std::size_t reach(Side& side, std::size_t inner, bool forward,
                                      const Step& step) const {
    const std::size_t block = std::min(inner / kBlock, side.saved.size() - 1);
    const bool is_kept = inner >= side.first;
    if (!is_kept || block * kBlock > side.first + side.phases_ns.size()) {
      side.first = block * kBlock;
      side.phases_ns.assign(1, side.saved[block].phase_ns);
      side.state = side.saved[block].state;
    }
    while (side.first + side.phases_ns.size() <= inner + 1) extend(side, forward, step);
    return inner - side.first;
  }

  template <class Step>
  void extend(Side& side, bool forward, const Step& step) const {
    if (side.phases_ns.size() == 2 * kBlock) {
      side.phases_ns.erase(side.phases_ns.begin(), side.phases_ns.begin() + kBlock);
      side.first += kBlock;
    }
    const auto last = static_cast<std::int64_t>(side.first + side.phases_ns.size() - 1);
    const double sign = forward ? 1.0 : -1.0;
    const double change_ns = step(side.state, forward ? last : -last - 1, sign);
    side.phases_ns.push_back(side.phases_ns.back() + sign * change_ns);
    const auto place = static_cast<std::size_t>(last) + 1;
    if (place == side.saved.size() * kBlock) {
      side.saved.push_back({side.phases_ns.back(), side.state});
    }
  }

  std::int64_t step_ns_ = 0;
  mutable Cell cell_;  // caches: values are functions of the index alone
  mutable Side forward_;
  mutable Side backward_;
};

}  // namespace simbench::sim
