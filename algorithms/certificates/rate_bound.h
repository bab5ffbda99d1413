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
// STOC 1994. A rate error may be anything from 0 on: a clock that may stand still bounds nothing.
// What may be longer than kLongest either way counts as kLongest, and is no bound.
#pragma once

#include <algorithm>
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
  static constexpr Picoseconds kLongest{std::int64_t{1} << 61};  // 26 days

  explicit RateBound(double ppm) : RateBound(0, ppm) {}
  // About a rate that is known within `ppm`.
  RateBound(double middle_ppm, double ppm)
      : least_(counted(std::floor((middle_ppm - ppm) * 1e3))),
        most_(counted(std::ceil((middle_ppm + ppm) * 1e3))) {
    SIMBENCH_ASSERT(ppm >= 0, "a rate error is not negative");
  }

  // Half of the width between the two bounds.
  double ppm() const { return static_cast<double>(most_ - least_) / 2 * 1e-3; }

  // The most true time, and the least, in which the clock counts `local`, which may be negative.
  Picoseconds most(Nanoseconds local) const { return Picoseconds(most_ps(local.count())); }
  Picoseconds least(Nanoseconds local) const { return Picoseconds(-most_ps(-local.count())); }

 private:
  static constexpr std::int64_t kOne = 1'000'000'000;
  // A clock that hardly moves bounds nothing, one that races next to nothing.
  static constexpr double kFewest = 1, kMost = 1e15;

  static std::int64_t counted(double gained_ns) {
    return static_cast<std::int64_t>(std::clamp(kOne + gained_ns, kFewest, kMost));
  }

  std::int64_t most_ps(std::int64_t local_ns) const {
    const Int128 scaled = Int128{local_ns} * 1000 * kOne;
    const Int128 most = local_ns >= 0 ? (scaled + least_ - 1) / least_
                                      : scaled / most_;  // division rounds towards zero, so up
    constexpr Int128 kEnd = kLongest.count();
    return static_cast<std::int64_t>(std::clamp(most, -kEnd, kEnd));
  }

  std::int64_t least_, most_;  // what it counts in a second, ns
};

}  // namespace simbench
