// The clocks of the host a node runs on, as instants of the kernel's monotonic clock.
//
// A node has one NodeClock. Sockets, cameras and timers stamp in monotonic time; the node clock
// converts a stamp to readings of the host's steady clock and of its system clock. Two kinds:
// SoftwareClock (the default), which the node disciplines and which changes nothing on the machine,
// and OsClock, the operating system's clock (--set-system-clock).
//
// A test's node may have an artificial oscillator: its steady clock then runs at a given skew
// against the monotonic clock, so that six nodes of one machine have six oscillators whose true
// errors are known.
//
// The observer is notified of every adjustment, also of the planned end of a slew, in order of
// time; present() is the adjustment without a change with which a log begins. Used by one thread.
//
// Errors: ClockError, one line for the user, for an impossible rate, a step above the limit, a
// missing permission; the clock is then as it was.
//
//   clock.observe([&](const ClockAdjustment& adjustment) { journal.write(adjustment); });
//   HostTime received = clock.system_at(kernel_stamp);
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include "algorithms/ports/clock_adjustment.h"
#include "algorithms/ports/host.h"
#include "clocks/disciplined_clock.h"
#include "hardware/clock/monotonic_time.h"

namespace simbench::hardware {

using clocks::ClockError;

// steady = steady_zero + (1 + skew) * (monotonic - monotonic_zero). The default is the identity.
// Rounded down to 1 ns; instants that the monotonic clock cannot reach become its last or first.
struct NodeOscillator {
  using Instant = MonotonicTime;
  MonotonicTime monotonic_zero{};
  SteadyTime steady_zero{};
  double skew_ppm = 0;

  double deviation_ns(MonotonicTime at) const {
    return skew_ppm / 1e6 * static_cast<double>((at - monotonic_zero).count());
  }
  SteadyTime steady(MonotonicTime at) const {
    const double ahead_ns = std::floor(deviation_ns(at));
    return steady_zero + (at - monotonic_zero) + Nanoseconds(static_cast<std::int64_t>(ahead_ns));
  }
  // The first instant at which the steady clock reads `at` or more.
  MonotonicTime when(SteadyTime at) const {
    return clocks::when_steady(*this, monotonic_zero, steady_zero, at);
  }
};

class NodeClock : public HostClock {
 public:
  using Observer = std::function<void(const ClockAdjustment&)>;

  // The oscillator as it runs now.
  virtual const NodeOscillator& oscillator() const = 0;
  // The readings of the clocks at an instant, now or in the recent past (the last 64 adjustments).
  virtual SteadyTime steady_at(MonotonicTime at) const { return oscillator().steady(at); }
  virtual HostTime system_at(MonotonicTime at) const = 0;
  // When the system clock will read `at`, not before `now`, unless it is adjusted meanwhile.
  virtual MonotonicTime when(HostTime at, MonotonicTime now) const = 0;

  virtual ClockAdjustment present(MonotonicTime now) const = 0;
  // Replaces the observer.
  virtual void observe(Observer observer) = 0;
  // Begins anew for a session: at the operating system's clock (plus a test node's offset), at rate
  // 0. Does nothing for the operating system's clock itself.
  virtual void restart() = 0;
};

}  // namespace simbench::hardware
