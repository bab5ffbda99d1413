#include "hardware/clock/node_clock.h"

#include <cmath>
#include <cstdint>

namespace simbench::hardware {
namespace {

// 73 years: further away than any instant that is meant, and far from what 64 bits hold.
constexpr double kFar = 2305843009213693952.0;

}  // namespace

SteadyTime NodeOscillator::steady(MonotonicTime at) const {
  const Nanoseconds elapsed = at - monotonic_zero;
  const double ahead_ns = std::floor(skew_ppm / 1e6 * static_cast<double>(elapsed.count()));
  return steady_zero + elapsed + Nanoseconds(static_cast<std::int64_t>(ahead_ns));
}

MonotonicTime NodeOscillator::when(SteadyTime at) const {
  const double about_ns =
      static_cast<double>(nanoseconds_of(at)) - static_cast<double>(nanoseconds_of(steady_zero));
  if (about_ns > kFar) return MonotonicTime::max();
  if (about_ns < -kFar) return MonotonicTime::min();
  const Nanoseconds local = at - steady_zero;
  const double skew = skew_ppm / 1e6;
  const double ahead_ns = static_cast<double>(local.count()) * skew / (1 + skew);
  MonotonicTime found = monotonic_zero + local - Nanoseconds(std::llround(ahead_ns));
  constexpr Nanoseconds kStep(1);
  while (steady(found) < at) found += kStep;
  while (steady(found - kStep) >= at) found -= kStep;
  return found;
}

}  // namespace simbench::hardware
