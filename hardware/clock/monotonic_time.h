// The time base of a real host's kernel: CLOCK_MONOTONIC, in nanoseconds.
//
// Everything in hardware/ that is stamped is stamped here first: sockets, cameras, timers. A node's
// clock (node_clock.h) turns these into the steady and the system time that algorithms see. Two
// processes of one machine share this clock, which is what makes the truth of the real-network
// experiment known.
//
// Source: clock_gettime(2).
#ifndef SIMBENCH_HARDWARE_CLOCK_MONOTONIC_TIME_H_
#define SIMBENCH_HARDWARE_CLOCK_MONOTONIC_TIME_H_

#include <chrono>

#include "algorithms/ports/time.h"

namespace simbench {

namespace time_base {
struct Monotonic {
  using duration = Nanoseconds;
};
}  // namespace time_base

using MonotonicTime = std::chrono::time_point<time_base::Monotonic>;

namespace hardware {

// std::chrono::steady_clock is CLOCK_MONOTONIC on Linux, and Asio's steady_timer counts on it.
inline MonotonicTime monotonic_now() {
  return MonotonicTime(
      std::chrono::duration_cast<Nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()));
}

inline std::chrono::steady_clock::time_point for_timer(MonotonicTime at) {
  return std::chrono::steady_clock::time_point(
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(at.time_since_epoch()));
}

}  // namespace hardware
}  // namespace simbench

#endif  // SIMBENCH_HARDWARE_CLOCK_MONOTONIC_TIME_H_
