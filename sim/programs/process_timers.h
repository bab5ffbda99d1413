// The timers of a process, and the times for which it waits.
//
// A timer is one of timerfd_create() or of timer_create(), setitimer() and alarm(); the world
// counts its expirations, and who they are for takes them. Times are nanoseconds on one of the
// process's clocks: its system clock, as programs read it (sim/programs/kernel_clock.h), or its
// oscillator. A time on the system clock is looked for at least every second, since that may be
// set. As in Linux, a timer set to a time to come from now follows no setting of the clock.
//
//   ProcessTimer timer(host, true);
//   timer.set({.left = kSecondNs, .interval = 0}, false);
//   const std::optional<TrueTime> look = timer.next_look();
//   const std::int64_t expirations = timer.take();
#pragma once

#include <cstdint>
#include <optional>

#include "recording/true_time.h"
#include "shim/protocol.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {

// Times further away are never; sums of two of them still fit.
inline constexpr std::int64_t kFarthestNs = std::int64_t{1} << 61;

struct WakeTime {
  shim::Deadline clock = shim::Deadline::kNever;  // not kAfter
  std::int64_t at = 0;
};

// From a request: what begins now has its time on the oscillator.
WakeTime wake_time(const SimHost& host, shim::Deadline kind, std::int64_t at);
bool is_past(const SimHost& host, const WakeTime& time);
// What is left until then, 0 if it is past; kFarthestNs: for ever.
std::int64_t left_ns(const SimHost& host, const WakeTime& time);
// When to look at the clock again, while it is not past; nothing: never.
std::optional<TrueTime> next_look(const SimHost& host, const WakeTime& time);

class ProcessTimer {
 public:
  // The host must outlive this.
  ProcessTimer(const SimHost& host, bool is_system) : host_(&host), is_system_(is_system) {}

  // `left` may be a time on the timer's clock. Neither may be negative.
  void set(const shim::TimerSetting& setting, bool is_absolute);
  shim::TimerSetting setting();
  // Since they were taken.
  std::int64_t expirations();
  std::int64_t take();
  // As next_look() of its next expiration.
  std::optional<TrueTime> next_look() const;

 private:
  // Counts what has expired until now.
  void expire();

  const SimHost* host_;
  bool is_system_;
  WakeTime next_{};  // kNever: disarmed
  std::int64_t interval_ = 0;
  std::int64_t expirations_ = 0;
};

}  // namespace simbench::sim
