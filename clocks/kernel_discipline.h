// What adjtimex() does to a host's system clock: the same for the simulated world's kernels and for
// a node's clock in software that real programs discipline.
//
// It keeps what the kernel keeps and moves on as the kernel does, when a second of the system clock
// begins. It knows no time of its own: whoever has it calls move_on() when next_second_ns() has
// come while is_moving(), and before each other call; every call acts at the present instant.
//
//  ADJ_FREQUENCY, ADJ_TICK      rate = freq / 65536 ppm + (tick - 10000) * 100 ppm, at once
//  ADJ_OFFSET, ADJ_TIMECONST    the kernel's loop (ntp_kernel_loop.h) while STA_PLL is set; what
//                               it adds to the phase goes evenly into each second. STA_FLL,
//                               STA_FREQHOLD. Constants get 4 more unless STA_NANO is set
//  ADJ_OFFSET_SINGLESHOT        adjtime(): 500 us in each second, beside the loop;
//                               ADJ_OFFSET_SS_READ reads what is left
//  ADJ_SETOFFSET                a step, in microseconds or (ADJ_NANO) nanoseconds
//  ADJ_STATUS                   STA_INS and STA_DEL make a leap second at the end of the day (UTC)
//  ADJ_MAXERROR, ADJ_ESTERROR, ADJ_TAI, ADJ_NANO, ADJ_MICRO: kept
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
//   void speed_up(AdjustedClock& steered) {
//     KernelDiscipline kernel(steered.epoch_ns());
//     timex request{};
//     request.modes = ADJ_FREQUENCY;
//     request.freq = 65536 * 12;  // 12 ppm
//     if (KernelDiscipline::refusal(request) == 0) kernel.apply(request, steered);
//   }
#pragma once

#include <sys/timex.h>

#include <cstdint>
#include <optional>

#include "algorithms/host_sync/ntp/ntp_kernel_loop.h"
#include "algorithms/ports/time.h"

namespace simbench::clocks {

// Linux sets no clock later than that, so that 30 years can follow.
inline constexpr std::int64_t kLatestSetting = INT64_MAX - 30 * 365 * 86'400 * kSecondNs;

// The clock that is steered, at the present instant.
class AdjustedClock {
 public:
  virtual ~AdjustedClock() = default;
  // What it reads, since 1970.
  virtual std::int64_t epoch_ns() const = 0;
  virtual void leap(Nanoseconds offset) = 0;
  // Against its oscillator, in place of the rate before.
  virtual void adjust_frequency(double ppb) = 0;
};

class KernelDiscipline {
 public:
  explicit KernelDiscipline(std::int64_t reading_ns);

  // EINVAL for what adjtimex() refuses, else 0.
  static int refusal(const timex& request);
  // Whether a request that is not refused changes the clock, rather than what is kept about it.
  bool changes_clock(const timex& request) const;
  void apply(const timex& request, AdjustedClock& clock);
  // The clock has been set.
  void forget(AdjustedClock& clock);
  // Fills in what adjtimex() returns for a request that came when adjtime() had so much left;
  // returns the clock's state.
  int read(std::int64_t reading_ns, const timex& request, long adjtime_before_us, timex& now) const;
  long adjtime_left_us() const { return adjtime_left_us_; }
  // Whether anybody has set or steered the clock, by a request that changes it or by setting it.
  bool was_steered() const { return was_steered_; }

  // Whether the kernel has work in the next second.
  bool is_moving() const;
  // When that begins, as the clock reads.
  std::int64_t next_second_ns() const { return (second_ + 1) * kSecondNs; }
  // Up to the present second.
  void move_on(AdjustedClock& clock);

 private:
  void keep(const timex& request);
  void set_status(int status);
  void update_offset(long offset);
  // What stays, without what the present second adds.
  double base_rate_ppb() const;
  void give_rate(AdjustedClock& clock);
  void begin_second(AdjustedClock& clock);
  void grow_error(std::int64_t seconds);
  // The seconds by which the clock leaps as a second begins.
  int leap();
  int leap_at(int wanted);

  KernelLoop loop_;
  std::int64_t second_;         // of the system clock: how far the kernel has counted
  double second_rate_ppb_ = 0;  // what this second adds to the rate
  double given_rate_ppb_ = 0;
  std::int64_t reference_s_ = 0;  // of the last ADJ_OFFSET
  long tick_ = 10'000;            // us in a hundredth of a second
  long adjtime_left_us_ = 0;
  bool was_steered_ = false;
  int status_ = STA_UNSYNC;
  int leap_state_ = TIME_OK;
  std::optional<std::int64_t> leap_at_s_;
  long max_error_us_ = 16'000'000;
  long estimated_error_us_ = 16'000'000;
  int tai_s_ = 0;
};

}  // namespace simbench::clocks
