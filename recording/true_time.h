// True time: the time of the simulated world, which no clock in it can read.
//
// Only sim/, the truth of a recording and evaluation/ use this type, never algorithms
// (docs/design.md section 5: one type for each time base). Unit: integer nanoseconds. Zero is the
// nominal start of host synchronisation; a world with a history (clocks set hours before) starts
// below zero.
#pragma once

#include <chrono>

#include "algorithms/ports/time.h"

namespace simbench {

namespace time_base {
struct True {
  using duration = Nanoseconds;
};
}  // namespace time_base

using TrueTime = std::chrono::time_point<time_base::True>;

}  // namespace simbench
