#include "hardware/clock/node_clock.h"

#include <cmath>
#include <cstdint>

namespace simbench::hardware {

SteadyTime NodeOscillator::steady(MonotonicTime at) const {
  const Nanoseconds elapsed = at - monotonic_zero;
  const double ahead_ns = std::floor(deviation_ns(at));
  return steady_zero + elapsed + Nanoseconds(static_cast<std::int64_t>(ahead_ns));
}

MonotonicTime NodeOscillator::when(SteadyTime at) const {
  return clocks::when_steady(*this, monotonic_zero, steady_zero, at);
}

}  // namespace simbench::hardware
