// The clocks of the host a node runs on, as instants of the kernel's monotonic clock.
//
// A node has one NodeClock. What stamps something (a socket, a camera, a timer) notes the
// monotonic instant; the node clock says what the host's steady clock and its system clock read
// then. Two kinds: SoftwareClock (the default), which is disciplined by the node and touches
// nothing, and OsClock, the operating system's clock (--set-system-clock).
//
// A node for tests may have a made-up oscillator: its steady clock then runs at a given skew
// against the monotonic clock, so that six nodes of one machine have six oscillators whose true
// errors are known.
//
// Every adjustment, also the planned end of a slew, is told to the observer in order of time, as
// recording/ wants it; present() is the adjustment that changes nothing with which a log begins.
// Used by one thread.
//
// Errors: what a clock refuses to do (a rate that is no clock's, a step above the limit, no
// permission) is a ClockError, one line for the user; the clock is then as it was.
//
//   clock.observe([&](const ClockAdjustment& adjustment) { journal.write(adjustment); });
//   HostTime received = clock.system_at(kernel_stamp);
#ifndef SIMBENCH_HARDWARE_CLOCK_NODE_CLOCK_H_
#define SIMBENCH_HARDWARE_CLOCK_NODE_CLOCK_H_

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
  SteadyTime steady(MonotonicTime at) const;
  // The first instant at which the steady clock reads `at` or more.
  MonotonicTime when(SteadyTime at) const;
};

class NodeClock : public HostClock {
 public:
  using Observer = std::function<void(const ClockAdjustment&)>;

  // The oscillator as it runs now.
  virtual const NodeOscillator& oscillator() const = 0;
  // What the clocks read at an instant, now or in the recent past (the last 64 adjustments).
  virtual SteadyTime steady_at(MonotonicTime at) const { return oscillator().steady(at); }
  virtual HostTime system_at(MonotonicTime at) const = 0;
  // When the system clock will read `at`, not before `now`, if nobody adjusts it meanwhile.
  virtual MonotonicTime when(HostTime at, MonotonicTime now) const = 0;

  virtual ClockAdjustment present(MonotonicTime now) const = 0;
  // From now on tells `observer`, in place of the one before.
  virtual void observe(Observer observer) = 0;
  // Begins anew, as a session wants it: back to what the operating system's clock says now (plus
  // the offset a test node was given), at rate 0. Does nothing for the operating system's clock
  // itself.
  virtual void restart() = 0;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_CLOCK_NODE_CLOCK_H_
