// How far a node may change the operating system's clock: the same for the clock itself and for a
// dry run.
//
// The kernel's frequency is a number of 2^-16 ppm between -500 and 500 ppm, and was perhaps already
// set to something by whoever kept the clock before: a rate is relative to that.
//
// Errors: ClockError; nothing has then changed.
#ifndef SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_LIMITS_H_
#define SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_LIMITS_H_

#include <string>

#include "hardware/clock/node_clock.h"
#include "hardware/clock/os_clock_calls.h"

namespace simbench::hardware {

class OsClockLimits {
 public:
  // `original_frequency`: the kernel's, as it was found (timex::freq).
  OsClockLimits(Nanoseconds max_step, long original_frequency)
      : max_step_(max_step), original_frequency_(original_frequency) {}

  // How far a step goes. Throws if that is too far.
  Nanoseconds check_step(HostTime from, HostTime to) const;
  // The kernel's frequency (timex::freq) with which the clock runs at `ppb` against what it did
  // before. Throws if the kernel does not go so far.
  long kernel_frequency(double ppb) const;
  // The rate at which a clock that runs at `frequency_ppb` is slewed by `offset`: max_rate_ppb, or
  // what the kernel has left in that direction. Throws if that is nothing.
  double slew_rate_ppb(Nanoseconds offset, double max_rate_ppb, double frequency_ppb) const;
  // The rate, against what the clock did before, that a kernel frequency makes.
  double rate_ppb(long kernel_frequency) const;

  long original_frequency() const { return original_frequency_; }

 private:
  Nanoseconds max_step_;
  long original_frequency_;
};

// The kernel's state of its clock. Throws ClockError.
timex read_kernel_clock(ClockCalls& calls);

// A line for the user if another program seems to keep this clock; else empty.
std::string other_keeper(const timex& kernel);

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CLOCK_OS_CLOCK_LIMITS_H_
