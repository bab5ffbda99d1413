// A reading of another clock and the monotonic instant at which it was taken.
//
// The clock is read between two readings of the monotonic clock, several times; the closest pair
// counts, and its middle is the instant: right to half of what a reading takes (some 20 ns), also
// on a busy machine.
//
//   const PairedReading reading = paired_reading(read_system_clock, monotonic_now);
#ifndef SIMBENCH_HARDWARE_CLOCK_PAIRED_READING_H_
#define SIMBENCH_HARDWARE_CLOCK_PAIRED_READING_H_

#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

struct PairedReading {
  MonotonicTime at{};
  HostTime reads{};
};

template <class Clock, class Monotonic>
PairedReading paired_reading(const Clock& clock, const Monotonic& monotonic) {
  constexpr int kTries = 8;
  PairedReading best;
  Nanoseconds closest = Nanoseconds::max();
  for (int i = 0; i < kTries; ++i) {
    const MonotonicTime before = monotonic();
    const HostTime reads = clock();
    const Nanoseconds took = monotonic() - before;
    if (took >= closest) continue;
    closest = took;
    best = {before + took / 2, reads};
  }
  return best;
}

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CLOCK_PAIRED_READING_H_
