// A random phase that is sampled step by step on a fixed grid of true time, in both directions from
// true zero, where it is 0; between grid points it is linear.
//
// The caller's step function changes the state over one step of the grid and returns the phase's
// gain. It is called once for every step, outwards from zero, and must take its random numbers from
// the step's index alone: then values depend neither on the order of the queries nor on when the
// world starts.
//
// Units: nanoseconds. Complexity: O(1) once the steps between true zero and the query are sampled
// and while the queries stay near each other. The last `kept_blocks` of 4096 steps (32 KiB) that
// were sampled in a direction are kept, and of all others the state at their beginning, from which
// they are sampled anew: service of many hours on a fine grid needs time, not memory.
//
// Copies share the steps that were sampled, so they are for one thread together.
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
#include <memory>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench::sim {

template <class State>
class GridWalk {
 public:
  static constexpr std::size_t kFewestBlocks = 2;

  GridWalk() = default;
  GridWalk(std::int64_t step_ns, const State& at_zero, std::size_t kept_blocks = kFewestBlocks)
      : step_ns_(step_ns),
        sides_(std::make_shared<Sides>(at_zero, std::max(kept_blocks, kFewestBlocks))) {}

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
  // Phases of the grid points from the block's first on, to the next block's first at most; empty:
  // not kept.
  struct Block {
    std::vector<double> phases_ns;
    State state{};  // at the last of them
  };
  // One direction of time; grid points are numbered by their distance from zero.
  struct Side {
    explicit Side(const State& at_zero) : saved{Point{0.0, at_zero}} {}
    std::vector<Point> saved;  // the first of each block, as far as they were sampled
    std::vector<Block> blocks;
    std::vector<std::size_t> kept;  // blocks, in the order in which they were begun
  };
  struct Sides {
    Sides(const State& at_zero, std::size_t most)
        : forward(at_zero), backward(at_zero), kept_blocks(most) {}
    Side forward;
    Side backward;
    std::size_t kept_blocks;
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
    Side& side = forward ? sides_->forward : sides_->backward;
    // The grid points around the step, by their distance from zero: `inner` and the next.
    const auto inner = static_cast<std::size_t>(forward ? index : -index - 1);
    const std::size_t at = inner % kBlock;
    if (inner / kBlock >= side.blocks.size() ||
        at + 1 >= side.blocks[inner / kBlock].phases_ns.size()) {
      reach(side, inner, forward, step);
    }
    const std::vector<double>& phases_ns = side.blocks[inner / kBlock].phases_ns;
    const double inner_ns = phases_ns[at];
    const double outer_ns = phases_ns[at + 1];
    cell_ = {.begin_ns = index * step_ns_,
             .phase_ns = forward ? inner_ns : outer_ns,
             .growth_ns = forward ? outer_ns - inner_ns : inner_ns - outer_ns};
  }

  // Samples the points at `inner` and the next. Out of the hot path.
  template <class Step>
  [[gnu::noinline]] void reach(Side& side, std::size_t inner, bool forward,
                               const Step& step) const {
    const std::size_t block = inner / kBlock;
    while (side.saved.size() <= block) {
      const std::size_t last = side.saved.size() - 1;
      extend(side, last, kBlock, forward, step);
      side.saved.push_back({side.blocks[last].phases_ns.back(), side.blocks[last].state});
    }
    extend(side, block, inner % kBlock + 1, forward, step);
  }

  // Samples the block up to its point `end`.
  template <class Step>
  void extend(Side& side, std::size_t number, std::size_t end, bool forward,
              const Step& step) const {
    if (side.blocks.size() <= number) side.blocks.resize(number + 1);
    if (side.blocks[number].phases_ns.empty()) begin(side, number);
    Block& block = side.blocks[number];
    std::vector<double>& phases_ns = block.phases_ns;
    if (end == kBlock) phases_ns.reserve(kBlock + 1);
    const double sign = forward ? 1.0 : -1.0;
    while (phases_ns.size() <= end) {
      const auto last = static_cast<std::int64_t>(number * kBlock + phases_ns.size() - 1);
      const double change_ns = step(block.state, forward ? last : -last - 1, sign);
      phases_ns.push_back(phases_ns.back() + sign * change_ns);
    }
  }

  void begin(Side& side, std::size_t number) const {
    if (side.kept.size() == sides_->kept_blocks) {
      side.blocks[side.kept.front()] = {};
      side.kept.erase(side.kept.begin());
    }
    side.kept.push_back(number);
    side.blocks[number] = {{side.saved[number].phase_ns}, side.saved[number].state};
  }

  std::int64_t step_ns_ = 0;
  mutable Cell cell_;             // caches: values are functions of the index alone
  std::shared_ptr<Sides> sides_;  // null without a grid
};

}  // namespace simbench::sim
