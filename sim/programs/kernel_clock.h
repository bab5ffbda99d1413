// What adjtimex() does, on a host's system clock.
//
// One for each host, shared by its programs, as the kernel's is. It keeps what the kernel keeps and
// moves on as the kernel does, when a second of the system clock begins; calls that change the
// clock take the time that the scenario says, what the kernel does by itself takes none.
//
//   ADJ_FREQUENCY, ADJ_TICK      rate = freq / 65536 ppm + (tick - 10000) * 100 ppm, at once
//   ADJ_OFFSET, ADJ_TIMECONST    the kernel's loop (ntp_kernel_loop.h) while STA_PLL is set; what
//                                it adds to the phase goes evenly into each second. STA_FLL,
//                                STA_FREQHOLD. Constants get 4 more unless STA_NANO is set
//   ADJ_OFFSET_SINGLESHOT        adjtime(): 500 us in each second, beside the loop;
//                                ADJ_OFFSET_SS_READ reads what is left
//   ADJ_SETOFFSET                a step, in microseconds or (ADJ_NANO) nanoseconds
//   ADJ_STATUS                   STA_INS and STA_DEL make a leap second at the end of the day (UTC)
//   ADJ_MAXERROR, ADJ_ESTERROR, ADJ_TAI, ADJ_NANO, ADJ_MICRO: kept
//
// Read back: `offset` is what the loop has left. maxerror grows by 500 us a second; above 16 s it
// stays there and sets STA_UNSYNC. The state is TIME_ERROR while STA_UNSYNC is set, which it is at
// first, else that of the leap second. A step ends the loop's offset and adjtime()'s, sets
// STA_UNSYNC and both error bounds to 16 s.
// Frequencies beyond 500 ppm are cut to that, offsets to 0.5 s, constants to 0 to 10; ticks outside
// 9000 to 11000 are EINVAL.
//
// Left out: PPS (its modes and bits do nothing, its fields are 0), the timer's ticks (rates change
// at the second's very begin, not at the tick after it), and the rounding of rates to what a
// clock source can count.
//
// Source: adjtimex(2); Linux, kernel/time/ntp.c and timekeeping.c.
//
//   KernelClock kernel(host);
//   boost::asio::co_spawn(context, kernel.run(), boost::asio::detached);
//   timex request{};
//   request.modes = ADJ_FREQUENCY;
//   request.freq = 65536 * 12;  // 12 ppm
//   const KernelClock::Answer answer = co_await kernel.adjust(request);
#ifndef SIMBENCH_SIM_PROGRAMS_KERNEL_CLOCK_H_
#define SIMBENCH_SIM_PROGRAMS_KERNEL_CLOCK_H_

#include <sys/timex.h>

#include <cstdint>
#include <optional>

#include "algorithms/host_sync/ntp/ntp_kernel_loop.h"
#include "algorithms/ports/host.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"

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
  explicit KernelClock(SimHost& host);

  // The kernel's own work, for ever: without it nothing is added to the phase. It costs an event a
  // second while there is something to add or a leap second ahead, else none.
  Task<void> run();

  Task<Answer> adjust(timex request);
  // clock_settime().
  Task<void> set(HostTime reading);

 private:
  // What a call does, at the instant at which it counts.
  void apply(const timex& request, SystemClock& clock, TrueTime at);
  void keep(const timex& request);
  void set_status(int status);
  void update_offset(long offset);
  // After a step.
  void forget(SystemClock& clock, TrueTime at);
  void fill(Answer& answer, HostTime reading) const;

  bool changes_clock(const timex& request) const;
  // What stays, without what the present second adds.
  double base_rate_ppb() const;
  void give_rate(SystemClock& clock, TrueTime at);
  // Whether the kernel has work in the next second.
  bool is_moving() const;
  // Up to the present second.
  void move_on(SystemClock& clock, TrueTime at);
  void begin_second(SystemClock& clock, TrueTime at);
  void grow_error(std::int64_t seconds);
  // The seconds by which the clock leaps as a second begins.
  int leap();
  int leap_at(int wanted);

  SimHost& host_;
  WaitPoint changed_;
  KernelLoop loop_;
  std::int64_t second_;         // of the system clock: how far the kernel has counted
  double second_rate_ppb_ = 0;  // what this second adds to the rate
  double given_rate_ppb_ = 0;
  std::int64_t reference_s_ = 0;  // of the last ADJ_OFFSET
  long tick_ = 10'000;            // us in a hundredth of a second
  long adjtime_left_us_ = 0;
  int status_ = STA_UNSYNC;
  int leap_state_ = TIME_OK;
  std::optional<std::int64_t> leap_at_s_;
  long max_error_us_ = 16'000'000;
  long estimated_error_us_ = 16'000'000;
  int tai_s_ = 0;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_PROGRAMS_KERNEL_CLOCK_H_
