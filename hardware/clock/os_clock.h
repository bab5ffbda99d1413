// The operating system's clock as the clock of a node (--set-system-clock).
//
// Steps are clock_settime, rates are the kernel's frequency (adjtimex), a slew is a change of
// frequency for as long as it takes. On Linux the kernel's frequency moves the monotonic clock and
// the system clock alike, so these stay a fixed number apart between steps. The steady clock is
// what the monotonic clock would read at the frequency that was found at the start.
//
// Contract
//  - A step beyond max_step, or a rate beyond the kernel's 500 ppm, is refused (ClockError). A slew
//    takes what the kernel has left, so it may take longer.
//  - Without the privilege (CAP_SYS_TIME) construction throws ClockError, which states how to get
//    it.
//  - `log` gets a line for each step, and one if another program keeps or changes this clock.
//  - The end of a slew is a timer of the context. observe(nullptr) and destruction end a slew at
//    once; destruction puts the frequency back to what was found. A kill leaves it as it was last.
//  - restart() does nothing.
//  - dry_run: checks and logs everything and sets nothing; the node's clock is a software clock.
//
// Source: adjtimex(2); kernel/time/ntp.c (the frequency is part of both clocks' rate).
//
//   auto clock = make_os_clock(context, kernel_clock_calls(), {.host = 3, .log = log_line});
#pragma once

#include <sys/timex.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "hardware/clock/monotonic_time.h"
#include "hardware/clock/node_clock.h"

namespace simbench::hardware {

// An OsClock's calls to the kernel, which tests replace by a fake kernel.
//
// kernel_clock_calls() are the real ones. Setting a clock needs CAP_SYS_TIME; reading does not.
//
// Source: clock_gettime(2), clock_settime(2), adjtimex(2).
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

// How far a node may change the operating system's clock; a dry run has the same limits.
//
// The kernel's frequency is a number of 2^-16 ppm between -500 and 500 ppm. It may have been set
// before by another program: rates are relative to the frequency that was found.
//
// Errors: ClockError; nothing has then changed.
class OsClockLimits {
 public:
  // `original_frequency`: the kernel's, as it was found (timex::freq).
  OsClockLimits(Nanoseconds max_step, long original_frequency)
      : max_step_(max_step), original_frequency_(original_frequency) {}

  // The size of a step. Throws if it is too large.
  Nanoseconds check_step(HostTime from, HostTime to) const;
  // The kernel's frequency (timex::freq) at which the clock runs at `ppb` against the frequency
  // that was found. Throws if that is beyond the kernel's limit.
  long kernel_frequency(double ppb) const;
  // The rate at which a clock that runs at `frequency_ppb` is slewed by `offset`: max_rate_ppb, or
  // what the kernel's limit leaves in that direction. Throws if that is nothing.
  double slew_rate_ppb(Nanoseconds offset, double max_rate_ppb, double frequency_ppb) const;
  // The largest rate, either way, that kernel_frequency() surely takes.
  double max_frequency_ppb() const;
  // The rate of a kernel frequency against the frequency that was found.
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

struct OsClockSettings {
  std::uint32_t host = 0;  // under which adjustments are reported
  Nanoseconds max_step = std::chrono::seconds(1);
  bool dry_run = false;
  std::function<void(const std::string&)> log;
};

// `calls` outlive the clock; the context must not run after the clock has gone.
std::unique_ptr<NodeClock> make_os_clock(boost::asio::io_context& context, ClockCalls& calls,
                                         OsClockSettings settings);

class OsClock final : public NodeClock {
 public:
  static constexpr std::size_t kHistory = 64;

  // Not for dry runs.
  OsClock(boost::asio::io_context& context, ClockCalls& calls, OsClockSettings settings);
  ~OsClock() override;
  OsClock(const OsClock&) = delete;
  OsClock& operator=(const OsClock&) = delete;

  Task<HostTime> now() override;
  Task<void> set(HostTime value) override;
  Task<void> adjust_frequency(double ppb) override;
  double max_frequency_ppb() const override { return limits_.max_frequency_ppb(); }
  Task<void> slew(Nanoseconds offset, double max_rate_ppb) override;

  const NodeOscillator& oscillator() const override { return settings_.back().oscillator; }
  SteadyTime steady_at(MonotonicTime at) const override;
  HostTime system_at(MonotonicTime at) const override;
  MonotonicTime when(HostTime at, MonotonicTime now) const override;
  ClockAdjustment present(MonotonicTime now) const override;
  void observe(Observer observer) override;
  void restart() override {}

 private:
  // Valid from `since` until the next setting.
  struct Setting {
    MonotonicTime since;
    Nanoseconds ahead;  // of the system clock before the monotonic clock
    NodeOscillator oscillator;
    double rate_ppb = 0;  // of both against the steady clock
  };

  const Setting& setting_at(MonotonicTime at) const;
  Nanoseconds measured_ahead() const;
  double slew_left_ns() const;
  // Runs from now on at this frequency plus a slew of slew_ns. Throws ClockError before anything
  // has changed.
  void run(double frequency_ppb, double slew_ns, double max_slew_ppb, Nanoseconds ahead);
  void end_slew();
  void end_slew_in_time();
  void set_kernel_frequency(long frequency);
  void begin(Nanoseconds ahead);
  // Logs what another program has done to the clock meanwhile.
  void look_for_others();

  ClockCalls& calls_;
  OsClockSettings options_;
  OsClockLimits limits_;
  long kernel_frequency_;  // as set last
  bool logged_others_ = false;
  double frequency_ppb_ = 0;  // that stays
  double slew_rate_ppb_ = 0;  // that ends with the slew
  double max_slew_ppb_ = 0;   // the requested limit
  double slew_ns_ = 0;        // to be added from slew_since_ on
  SteadyTime slew_since_{};
  SteadyTime slew_end_{};
  std::deque<Setting> settings_;
  Observer observer_;
  boost::asio::steady_timer slew_timer_;
};

}  // namespace simbench::hardware
