// What an OsClock asks of the kernel, so that tests can put a made-up kernel in its place.
//
// kernel_clock_calls() are the real ones. Setting a clock needs CAP_SYS_TIME; reading does not.
//
// Source: clock_gettime(2), clock_settime(2), adjtimex(2).
#ifndef SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_CALLS_H_
#define SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_CALLS_H_

#include <sys/timex.h>

#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

class ClockCalls {
 public:
  virtual ~ClockCalls() = default;
  virtual MonotonicTime monotonic() = 0;
  virtual HostTime system() = 0;
  // Steps the system clock: 0, or the error's number.
  virtual int set_system(HostTime value) = 0;
  // adjtimex(2) on the system clock: 0, or the error's number. Modes of 0 only read.
  virtual int adjust(timex& request) = 0;
};

// Live as long as the program.
ClockCalls& kernel_clock_calls();

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_CALLS_H_
