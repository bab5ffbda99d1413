// How far a clock may be from true time's pace: what a data sheet says of a quartz.
//
// A clock whose rate error stays within +-50 ppm and that counted `local` passed between
// local / (1 + 50e-6) and local / (1 - 50e-6) of true time. Both are rounded outward to a
// picosecond, so that what follows from them is sure and not merely near.
//
//   const RateBound quartz(50.0);                        // ppm, either way
//   Picoseconds at_most = quartz.most(from_ms(1000));    // 1.00005 s and a little
//   Picoseconds at_least = quartz.least(from_ms(1000));
//   const RateBound measured(12.5, 2.0);                 // 12.5 ppm fast, within 2
//
// Source: the drift constraints of Patt-Shamir and Rajsbaum, "A theory of clock synchronization",
// STOC 1994. Range: 0 <= rate error < 10^6 ppm; intervals up to 50 days either way.
#pragma once

#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <ratio>

#include "algorithms/ports/assert.h"
#include "algorithms/ports/time.h"
#include "laws/saturate.h"

namespace simbench {

using Picoseconds = std::chrono::duration<std::int64_t, std::pico>;

// Takes picoseconds alone: other durations are those of ports/time.h.
template <std::same_as<Picoseconds> Duration>
constexpr double to_ms(Duration d) {
  return static_cast<double>(d.count()) * 1e-9;
}

class RateBound {
 public:
  explicit RateBound(double ppm) : RateBound(0, ppm) {}
  // About a rate that is known within `ppm`.
  RateBound(double middle_ppm, double ppm)
      : least_(kOne + static_cast<std::int64_t>(std::floor((middle_ppm - ppm) * 1e3))),
        most_(kOne + static_cast<std::int64_t>(std::ceil((middle_ppm + ppm) * 1e3))) {
    SIMBENCH_ASSERT(ppm >= 0 && least_ > 0 && most_ < 2 * kOne,
                    "a rate error is from 0 to below 10^6 ppm");
  }

  // Half of the width between the two bounds.
  double ppm() const { return static_cast<double>(most_ - least_) / 2 * 1e-3; }

  // The most true time, and the least, in which the clock counts `local`, which may be negative.
  Picoseconds most(Nanoseconds local) const { return Picoseconds(most_ps(local.count())); }
  Picoseconds least(Nanoseconds local) const { return Picoseconds(-most_ps(-local.count())); }

 private:
  static constexpr std::int64_t kOne = 1'000'000'000;

  std::int64_t most_ps(std::int64_t local_ns) const {
    const Int128 scaled = Int128{local_ns} * 1000 * kOne;
    if (local_ns >= 0) return saturate((scaled + least_ - 1) / least_);
    return saturate(scaled / most_);  // division rounds towards zero, which is up
  }

  std::int64_t least_, most_;  // what it counts in a second, ns
};

}  // namespace simbench
