// The times that a synchronisation algorithm may see, one type per time base.
//
// Every stamp in simbench belongs to exactly one time base. Each base has its own
// std::chrono::time_point type, so stamps of different bases neither compare nor subtract: a host's
// reading minus a camera's is a compile-time error. The one named exception is
// offset_between(a, b).
//
//   HostTime    what a host's system clock reads: set, stepped and slewed by synchronisation
//   SteadyTime  what a host's oscillator counts: never set, never stepped (deadlines, intervals)
//   HardwareTime  what a network card's own clock counts (a PTP hardware clock)
//   TsfTime     what a Wi-Fi access point counts, which its beacons tell
//   DeviceTime  what a camera's clock counts, unwrapped; its 32-bit register is DeviceStamp
//   GlobalTime  the common time that device_time assigns to a frame: the master host's system time
//
// True time is not here: algorithms never see it (recording/true_time.h).
//
// Unit: integer nanoseconds, except DeviceTime, which is in integer microseconds like the register.
//
//   HostTime sent = ...;
//   HostTime later = sent + from_ms(2.5);
//   double gap_ms = to_ms(later - sent);
#pragma once

#include <chrono>
#include <cstdint>

namespace simbench {

using Nanoseconds = std::chrono::duration<std::int64_t, std::nano>;
using Microseconds = std::chrono::duration<std::int64_t, std::micro>;

namespace time_base {
struct HostSystem {
  using duration = Nanoseconds;
};
struct HostSteady {
  using duration = Nanoseconds;
};
struct Hardware {
  using duration = Nanoseconds;
};
struct Tsf {
  using duration = Nanoseconds;
};
struct Device {
  using duration = Microseconds;
};
struct Global {
  using duration = Nanoseconds;
};
}  // namespace time_base

using HostTime = std::chrono::time_point<time_base::HostSystem>;
using SteadyTime = std::chrono::time_point<time_base::HostSteady>;
using HardwareTime = std::chrono::time_point<time_base::Hardware>;
using TsfTime = std::chrono::time_point<time_base::Tsf>;
using DeviceTime = std::chrono::time_point<time_base::Device>;
using GlobalTime = std::chrono::time_point<time_base::Global>;

// A camera's 32-bit microsecond register as it is read: wraps every 2^32 us (71 min 35 s).
struct DeviceStamp {
  std::uint32_t us = 0;
  friend bool operator==(DeviceStamp, DeviceStamp) = default;
};

inline constexpr std::int64_t kSecondNs = 1'000'000'000;
// After so long the register of a camera's clock begins anew.
inline constexpr std::int64_t kDeviceRegisterNs = (std::int64_t{1} << 32) * 1000;

// a / b, rounded down; b > 0.
constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - static_cast<std::int64_t>(a % b < 0);
}

// The nearest whole nanosecond, halves away from zero as std::llround has them, and the next below
// or above, or equal, as std::floor and std::ceil have it: without a call of them, and without a
// branch, which half of all values would take. |ns| < 2^63.
constexpr Nanoseconds from_ns(double ns) {
  const auto whole = static_cast<std::int64_t>(ns);
  const double rest = ns - static_cast<double>(whole);
  return Nanoseconds(whole + static_cast<std::int64_t>(rest >= 0.5) -
                     static_cast<std::int64_t>(rest <= -0.5));
}
constexpr Nanoseconds from_ns_down(double ns) {
  const auto whole = static_cast<std::int64_t>(ns);
  return Nanoseconds(whole - static_cast<std::int64_t>(ns < static_cast<double>(whole)));
}
constexpr Nanoseconds from_ns_up(double ns) {
  const auto whole = static_cast<std::int64_t>(ns);
  return Nanoseconds(whole + static_cast<std::int64_t>(ns > static_cast<double>(whole)));
}
// To the nearest nanosecond, and back. Exact for |ms| < 9e9 (104 days).
constexpr Nanoseconds from_ms(double ms) { return from_ns(ms * 1e6); }
constexpr Nanoseconds from_us(double us) { return from_ns(us * 1e3); }
constexpr Nanoseconds from_seconds(double s) { return from_ms(s * 1e3); }
constexpr double to_ns(Nanoseconds d) { return static_cast<double>(d.count()); }
constexpr double to_ms(Nanoseconds d) { return static_cast<double>(d.count()) * 1e-6; }
constexpr double to_seconds(Nanoseconds d) { return static_cast<double>(d.count()) * 1e-9; }

// The stamp as a count of nanoseconds since the zero of its own base.
template <class Base, class Duration>
constexpr std::int64_t nanoseconds_of(std::chrono::time_point<Base, Duration> t) {
  return std::chrono::duration_cast<Nanoseconds>(t.time_since_epoch()).count();
}

// How long before `at` a camera read its register, where it stamps with its host's steady clock, in
// whole microseconds: of the readings that the register may stand for, the one nearest to `at`.
// Within half a wrap.
constexpr Nanoseconds age_of(DeviceStamp stamp, SteadyTime at) {
  const std::int64_t at_us = floor_div(at.time_since_epoch().count(), 1000);
  const std::int64_t rest_ns = (at.time_since_epoch().count() % 1000 + 1000) % 1000;
  const auto later = static_cast<std::int32_t>(stamp.us - static_cast<std::uint32_t>(at_us));
  return Nanoseconds(rest_ns - 1000 * std::int64_t{later});
}

// The steady time at which it did, near `near`.
constexpr SteadyTime steady_of(DeviceStamp stamp, SteadyTime near) {
  return near - age_of(stamp, near);
}

// The offset of `a` against `b`, two readings of different bases at one instant.
template <class BaseA, class DurationA, class BaseB, class DurationB>
constexpr Nanoseconds offset_between(std::chrono::time_point<BaseA, DurationA> a,
                                     std::chrono::time_point<BaseB, DurationB> b) {
  return Nanoseconds(nanoseconds_of(a) - nanoseconds_of(b));
}

}  // namespace simbench
