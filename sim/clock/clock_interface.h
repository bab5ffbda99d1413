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
#include <limits>

#include "algorithms/ports/time.h"

namespace simbench::sim {

// A unit to which times are rounded down; 0: they stay as they are. Clocks round each reading, so
// the division is a multiplication by a reciprocal that is known before.
class Granularity {
 public:
  constexpr Granularity() : Granularity(Nanoseconds(0)) {}
  constexpr explicit Granularity(Nanoseconds unit)
      : unit_(static_cast<std::uint64_t>(unit.count())),
        reciprocal_(unit_ == 0 ? 0 : std::numeric_limits<std::uint64_t>::max() / unit_) {}

  // The largest phase + n * unit that is not after t.
  template <class Time>
  constexpr Time round_down(Time t, Nanoseconds phase = {}) const {
    if (unit_ == 0) return t;
    return t - Nanoseconds(above((t.time_since_epoch() - phase).count()));
  }

 private:
  __extension__ using Wide = unsigned __int128;

  // How far `ns` is above a multiple of the unit.
  constexpr std::int64_t above(std::int64_t ns) const {
    // A negative one is counted down from -1, so that the number to divide is below 2^63. Then the
    // quotient is too small by 1 at most.
    const std::uint64_t n = static_cast<std::uint64_t>(ns < 0 ? ~ns : ns);
    const auto quotient = static_cast<std::uint64_t>((static_cast<Wide>(n) * reciprocal_) >> 64);
    std::uint64_t part = n - quotient * unit_;
    if (part >= unit_) part -= unit_;
    return static_cast<std::int64_t>(ns < 0 ? unit_ - 1 - part : part);
  }

  std::uint64_t unit_;
  std::uint64_t reciprocal_;
};

class ClockInterface {
 public:
  constexpr ClockInterface(Nanoseconds tick, Nanoseconds tick_phase, Nanoseconds resolution)
      : tick_(tick), tick_phase_(tick_phase), resolution_(resolution) {}

  // The reading of the clock's own counter, used for the kernel's stamps.
  constexpr HostTime tick_of(HostTime exact) const { return tick_.round_down(exact, tick_phase_); }
  // The reading that a get call returns.
  constexpr HostTime read(HostTime exact) const { return resolution_.round_down(tick_of(exact)); }
  // The setting after a set call with this value.
  constexpr HostTime set_to(HostTime value) const { return resolution_.round_down(value); }

 private:
  Granularity tick_;
  Nanoseconds tick_phase_;
  Granularity resolution_;
};

}  // namespace simbench::sim
