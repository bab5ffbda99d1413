// A node's clock for tests of what only reads it: steady and system time are the monotonic clock's,
// plus a fixed offset each.
#pragma once

#include "hardware/clock/node_clock.h"

namespace simbench::hardware {

class PlainClock final : public NodeClock {
 public:
  static constexpr Nanoseconds kSystemAhead = std::chrono::hours(1000);
  static constexpr Nanoseconds kSteadyAhead = std::chrono::hours(10);

  PlainClock() {
    oscillator_.monotonic_zero = monotonic_now();
    oscillator_.steady_zero =
        SteadyTime(oscillator_.monotonic_zero.time_since_epoch() + kSteadyAhead);
  }
  SteadyTime steady_now() const { return steady_at(monotonic_now()); }

  const NodeOscillator& oscillator() const override { return oscillator_; }
  HostTime system_at(MonotonicTime at) const override {
    return HostTime(at.time_since_epoch() + kSystemAhead);
  }
  MonotonicTime when(HostTime at, MonotonicTime now) const override {
    return std::max(now, MonotonicTime(at.time_since_epoch() - kSystemAhead));
  }
  ClockAdjustment present(MonotonicTime /*now*/) const override { return {}; }
  void observe(Observer /*observer*/) override {}
  void restart() override {}

  Task<HostTime> now() override { co_return system_at(monotonic_now()); }
  Task<void> set(HostTime /*value*/) override { co_return; }
  Task<void> adjust_frequency(double /*ppb*/) override { co_return; }
  Task<void> slew(Nanoseconds /*offset*/, double /*max_rate_ppb*/) override { co_return; }

 private:
  NodeOscillator oscillator_;
};

}  // namespace simbench::hardware
