// Where another clock is, as a straight line over one's own steady clock.
//
// What an estimator of a remote clock gives and what the steering of a system clock takes: neither
// end depends on how the own system clock was set or slewed meanwhile.
//
//   ClockLine line{.at = s, .value = m, .rate_ppb = 12'000};   // at s it read m, and gains 12 ppm
//   HostTime then = line.read(s + from_ms(1000));              // m + 1.000012 s
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_CLOCK_LINE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_CLOCK_LINE_H_

#include "algorithms/ports/time.h"

namespace simbench {

struct ClockLine {
  SteadyTime at{};
  HostTime value{};
  double rate_ppb = 0;  // against the steady clock

  HostTime read(SteadyTime when) const {
    const Nanoseconds since = when - at;
    const double gained_ns = static_cast<double>(since.count()) * rate_ppb * 1e-9;
    return value + since + Nanoseconds(std::llround(gained_ns));
  }
  // The instant at which it reads `reading`, to the nanosecond.
  SteadyTime when(HostTime reading) const {
    SteadyTime guess = at + (reading - value);
    // Each pass multiplies the error by the rate, which is far below 1e-2.
    for (int pass = 0; pass < 4; ++pass) guess += reading - read(guess);
    return guess;
  }
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_CLOCK_LINE_H_
