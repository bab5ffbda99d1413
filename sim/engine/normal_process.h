// A stationary normal process of mean 0 and standard deviation 1, readable at any instant.
//
// It is a blend of independent values on a grid of true time, so it is about constant over a small
// part of the grid's step and forgotten after two steps. The blend's weights, the cosine and the
// sine of a quarter turn over a step, keep the variance 1 everywhere. Values come from the grid's
// index alone: they depend neither on the order nor on the number of the readings.
//
// Cost: some 20 ns while readings stay within a step, two more normal draws in another.
//
//   NormalProcess load(run_seed, kMessage, 3, from_ms(100));
//   const double z = load.at(engine.now());
//   const double share = normal_probability(z);   // uniform in (0, 1)
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "algorithms/ports/assert.h"
#include "algorithms/ports/time.h"
#include "recording/true_time.h"
#include "sim/engine/random.h"

namespace simbench::sim {

class NormalProcess {
 public:
  // `kind` and `number` tell the processes of a run apart; `step` is positive.
  NormalProcess(std::uint64_t run_seed, ComponentKey kind, std::uint64_t number, Nanoseconds step)
      : values_(KeyedStreams(run_seed, kind).of(number)), step_ns_(step.count()) {
    SIMBENCH_ASSERT(step_ns_ > 0, "a process needs a grid");
  }

  double at(TrueTime t) {
    const std::int64_t since_zero_ns = t.time_since_epoch().count();
    const std::int64_t index = floor_div(since_zero_ns, step_ns_);
    if (!is_sampled_ || index != index_) {
      begin_ = is_sampled_ && index == index_ + 1 ? end_ : value(index);
      end_ = value(index + 1);
      index_ = index;
      is_sampled_ = true;
    }
    const double part =
        static_cast<double>(since_zero_ns - index * step_ns_) / static_cast<double>(step_ns_);
    const double angle = part * std::numbers::pi / 2;
    return std::cos(angle) * begin_ + std::sin(angle) * end_;
  }

 private:
  double value(std::int64_t index) const {
    return values_.stream(static_cast<std::uint64_t>(index)).normal(1);
  }

  KeyedStreams values_;
  std::int64_t step_ns_;
  std::int64_t index_ = 0;  // of the grid point before the last reading
  double begin_ = 0;        // the values there and at the next
  double end_ = 0;
  bool is_sampled_ = false;
};

}  // namespace simbench::sim
