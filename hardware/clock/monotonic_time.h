// The time base of a real host's kernel: CLOCK_MONOTONIC, in nanoseconds.
//
// Sockets, cameras and timers are stamped in this base first. A node's clock (node_clock.h) turns
// the stamps into the steady and the system time that algorithms see. All processes of a machine
// share this clock, so the truth of the real-network experiment is known.
//
// Source: clock_gettime(2), prctl(2).
#pragma once

#include <sys/prctl.h>

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

// Makes timers of this thread, and of threads that it starts later, expire on time instead of up to
// 50 us later.
inline void ask_for_exact_timers() { prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL); }

// What the operating system's clock reads (CLOCK_REALTIME).
inline HostTime read_system_clock() {
  return HostTime(
      std::chrono::duration_cast<Nanoseconds>(std::chrono::system_clock::now().time_since_epoch()));
}

// A reading of another clock and the monotonic instant at which it was taken.
struct PairedReading {
  MonotonicTime at{};
  HostTime reads{};
};

// Reads the clock between two readings of the monotonic clock, `tries` times or until a pair is
// `close_enough`. The closest pair counts, and its middle is the instant: right to half of what a
// reading takes (some 20 ns), also on a busy machine.
template <class Clock, class Monotonic>
PairedReading paired_reading(const Clock& clock, const Monotonic& monotonic, int tries = 8,
                             Nanoseconds close_enough = Nanoseconds::min()) {
  PairedReading best;
  Nanoseconds closest = Nanoseconds::max();
  for (int i = 0; i < tries && closest > close_enough; ++i) {
    const MonotonicTime before = monotonic();
    const HostTime reads = clock();
    const Nanoseconds took = monotonic() - before;
    if (took >= closest) continue;
    closest = took;
    best = {before + took / 2, reads};
  }
  return best;
}

}  // namespace hardware
}  // namespace simbench
