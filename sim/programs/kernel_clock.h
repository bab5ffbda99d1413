// What adjtimex() does, on a host's system clock.
//
// One for each host, shared by its programs, as the kernel's is. It keeps what the kernel keeps
// (frequency, tick, status, error bounds, time constant, TAI offset) and passes changes on to the
// host's clock, whose calls take the time that the scenario says.
//
//   ADJ_FREQUENCY, ADJ_TICK      rate = freq / 65536 ppm + (tick - 10000) * 100 ppm
//   ADJ_SETOFFSET                a step, in microseconds or (ADJ_NANO) nanoseconds
//   ADJ_OFFSET_SINGLESHOT        a slew at 500 ppm, as adjtime(); ADJ_OFFSET_SS_READ
//   ADJ_STATUS, ADJ_MAXERROR, ADJ_ESTERROR, ADJ_TIMECONST, ADJ_TAI, ADJ_NANO, ADJ_MICRO: kept
//
// The kernel's own loop (ADJ_OFFSET while STA_PLL is set) is not there: EOPNOTSUPP, which no kernel
// says. A step sets STA_UNSYNC and both error bounds to 16 s.
// Frequencies beyond 500 ppm are cut to that, ticks outside 9000 to 11000 are EINVAL, as in Linux.
// An unfinished slew of adjtime() reads as none. The state is TIME_ERROR while STA_UNSYNC is set,
// which it is at first.
//
// Source: adjtimex(2).
//
//   KernelClock kernel(host);
//   timex request{};
//   request.modes = ADJ_FREQUENCY;
//   request.freq = 65536 * 12;  // 12 ppm
//   const KernelClock::Answer answer = co_await kernel.adjust(request);
#ifndef SIMBENCH_SIM_PROGRAMS_KERNEL_CLOCK_H_
#define SIMBENCH_SIM_PROGRAMS_KERNEL_CLOCK_H_

#include <sys/timex.h>

#include "algorithms/ports/host.h"

namespace simbench::sim {

// The system clocks of the simulated world begin at 0; those of its programs at this time, the
// beginning of 2026, since some refuse earlier ones.
inline constexpr std::int64_t kEpochNs = 1'767'225'600 * kSecondNs;

constexpr std::int64_t epoch_ns(HostTime time) { return nanoseconds_of(time) + kEpochNs; }
constexpr HostTime from_epoch_ns(std::int64_t ns) { return HostTime(Nanoseconds(ns - kEpochNs)); }

class KernelClock {
 public:
  struct Answer {
    int state = TIME_OK;
    int error = 0;  // an errno
    timex now{};
  };

  // The host must outlive this.
  explicit KernelClock(Host& host);

  Task<Answer> adjust(timex request);
  // The clock was set by clock_settime(): it is not synchronised any more.
  void was_set();

 private:
  double rate_ppb() const;
  void keep(const timex& request);
  Task<void> step(timex request);
  void fill(Answer& answer, HostTime reading) const;

  Host& host_;
  long frequency_ = 0;  // 2^-16 ppm
  long tick_ = 10'000;  // us in a hundredth of a second
  int status_ = STA_UNSYNC;
  long max_error_us_ = 16'000'000;
  long estimated_error_us_ = 16'000'000;
  long time_constant_ = 2;
  int tai_s_ = 0;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_PROGRAMS_KERNEL_CLOCK_H_
