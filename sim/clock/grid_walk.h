// A random phase that is sampled step by step on a fixed grid of true time, in both directions from
// true zero, where it is 0; between grid points it is linear.
//
// The caller's step function changes the state over one step of the grid and returns the phase's
// gain. It is called once for every step, outwards from zero, and must take its random numbers from
// the step's index alone: then values depend neither on the order of the queries nor on when the
// world starts.
//
// Units: nanoseconds. Complexity: O(1) once the steps between true zero and the query are sampled;
// 8 bytes each.
//
//   GridWalk<double> walk(step_ns, frequency_at_zero);
//   double ns = walk.phase_ns(t_ns, [&](double& frequency, std::int64_t index, double sign) {
//     return (frequency += sign * draw(index)) * step_ns;
//   });
#ifndef SIMBENCH_SIM_CLOCK_GRID_WALK_H_
#define SIMBENCH_SIM_CLOCK_GRID_WALK_H_

#include <cstdint>
#include <vector>

#include "algorithms/ports/time.h"

namespace simbench::sim {

template <class State>
class GridWalk {
 public:
  GridWalk() = default;
  GridWalk(std::int64_t step_ns, const State& at_zero)
      : step_ns_(step_ns), forward_{{0.0}, at_zero}, backward_{{0.0}, at_zero} {}

  std::int64_t step_ns() const { return step_ns_; }

  // `step(state, index, sign)` moves the state over the step that begins at grid point `index`,
  // forwards in time if sign is 1 and backwards if it is -1, and returns the phase's growth from
  // that grid point to the next.
  template <class Step>
  double phase_ns(std::int64_t since_zero_ns, const Step& step) const {
    const std::int64_t index = floor_div(since_zero_ns, step_ns_);
    const double part =
        static_cast<double>(since_zero_ns - index * step_ns_) / static_cast<double>(step_ns_);
    const double before_ns = grid_phase_ns(index, step);
    return before_ns + part * (grid_phase_ns(index + 1, step) - before_ns);
  }

 private:
  // One direction of time; phases_ns[i] belongs to grid point i or -i.
  struct Side {
    std::vector<double> phases_ns;
    State state;  // at the last of these points
  };

  template <class Step>
  double grid_phase_ns(std::int64_t index, const Step& step) const {
    const bool forward = index >= 0;
    const double sign = forward ? 1.0 : -1.0;
    Side& side = forward ? forward_ : backward_;
    const auto place = static_cast<std::size_t>(forward ? index : -index);
    while (side.phases_ns.size() <= place) {
      const auto last = static_cast<std::int64_t>(side.phases_ns.size()) - 1;
      const double change_ns = step(side.state, forward ? last : -last - 1, sign);
      side.phases_ns.push_back(side.phases_ns.back() + sign * change_ns);
    }
    return side.phases_ns[place];
  }

  std::int64_t step_ns_ = 0;
  mutable Side forward_{};  // a cache: values are functions of the index alone
  mutable Side backward_{};
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_CLOCK_GRID_WALK_H_
