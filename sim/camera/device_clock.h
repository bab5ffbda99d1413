// A camera's clock: an oscillator counted in microseconds by a 32-bit register.
//
// The register starts anywhere and wraps every 2^32 us (71 min 35 s). A stamp is the reading with
// the device's own timing noise, rounded down to a whole microsecond.
//
// Source: docs/reference/d455.md section 1; docs/reference/calibration.md section 2 ("Cameras").
#pragma once

#include <cstdint>

#include "clocks/prefetch.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/clock/oscillator.h"

namespace simbench::sim {

class DeviceClock {
 public:
  // The register reads `epoch_ms` at true time `zero`.
  DeviceClock(OscillatorModel oscillator, double epoch_ms, TrueTime zero)
      : epoch_ns_(from_ms(epoch_ms).count()), zero_(zero), oscillator_(std::move(oscillator)) {}

  // The register at `t`, with `noise_ns` of timing noise.
  DeviceStamp stamp(TrueTime t, double noise_ns) {
    const double wander_ns = oscillator_.deviation_ns(t) + noise_ns;
    const std::int64_t ns = epoch_ns_ + (t - zero_ + from_ns_down(wander_ns)).count();
    return DeviceStamp{static_cast<std::uint32_t>(floor_div(ns, 1000))};
  }

  // Prepares a stamp (clocks/prefetch.h).
  void prefetch() const { clocks::prefetch(this, 128); }

  // Nanoseconds of true time per device nanosecond, by the constant skew alone: the stretch of the
  // camera's own frame period.
  double true_per_device() const { return 1.0 / (1.0 + oscillator_.skew()); }

  const OscillatorModel& oscillator() const { return oscillator_; }

 private:
  std::int64_t epoch_ns_;
  TrueTime zero_;
  OscillatorModel oscillator_;
};

}  // namespace simbench::sim
