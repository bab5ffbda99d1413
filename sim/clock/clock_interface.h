// The granularity of a system clock behind the operating system's calls.
//
// It rounds down twice: the clock itself advances in ticks of some phase (15.625 ms on a Windows
// host without a high-resolution timer, 0 for a continuous clock), and the interface passes
// readings and settings in units of its resolution (1 ms for SYSTEMTIME). A setting is not rounded
// to a tick, as only readings come from the ticking counter.
//
// Source: docs/reference/calibration.md section 2 ("Host clock").
//
//   const ClockInterface interface(from_ms(15.625), from_ms(4), from_ms(1));
//   HostTime seen = interface.read(system_clock.read(now));
#pragma once

#include <cstdint>

#include "algorithms/ports/time.h"

namespace simbench::sim {

// The largest phase + n * unit that is not after t; t itself if the unit is 0.
template <class Time>
constexpr Time round_down(Time t, Nanoseconds unit, Nanoseconds phase = {}) {
  if (unit.count() == 0) return t;
  const std::int64_t since_phase = (t.time_since_epoch() - phase).count();
  const std::int64_t part = since_phase % unit.count();
  const Nanoseconds above{part < 0 ? part + unit.count() : part};
  return t - above;
}

class ClockInterface {
 public:
  constexpr ClockInterface(Nanoseconds tick, Nanoseconds tick_phase, Nanoseconds resolution)
      : tick_(tick), tick_phase_(tick_phase), resolution_(resolution) {}

  // The reading of the clock's own counter, used for the kernel's stamps.
  constexpr HostTime tick_of(HostTime exact) const { return round_down(exact, tick_, tick_phase_); }
  // The reading that a get call returns.
  constexpr HostTime read(HostTime exact) const { return round_down(tick_of(exact), resolution_); }
  // The setting after a set call with this value.
  constexpr HostTime set_to(HostTime value) const { return round_down(value, resolution_); }

 private:
  Nanoseconds tick_;
  Nanoseconds tick_phase_;
  Nanoseconds resolution_;
};

}  // namespace simbench::sim
