#include "algorithms/capture_alignment/frame_clock.h"

#include <optional>
#include <utility>

#include "algorithms/device_time/hull.h"
#include "algorithms/device_time/poll_estimators.h"

namespace simbench {
namespace {

constexpr std::uint32_t kFewestReadings = 3;

// The estimators know one clock of a host, which here is the steady one.
HostTime as_host_time(SteadyTime steady) { return HostTime(steady.time_since_epoch()); }

}  // namespace

FrameClock::FrameClock()
    : by_arrivals_(make_switching_hull(SwitchingHullSettings{})),
      by_readings_(make_two_way_poll(TwoWayPollSettings{})) {}

SteadyTime FrameClock::estimated(const FrameArrival& frame) {
  if (const std::optional<CameraClockReading>& reading = frame.reading) {
    by_readings_->on_poll({.device = unwrapper_.unwrap(reading->device),
                           .t0 = as_host_time(reading->t0_steady),
                           .t1 = as_host_time(reading->t1_steady),
                           .t0_steady = reading->t0_steady,
                           .t1_steady = reading->t1_steady});
    ++readings_;
  }
  const DeviceSample sample{.sensor = unwrapper_.unwrap(frame.sensor),
                            .arrival = as_host_time(frame.arrival_steady),
                            .arrival_steady = frame.arrival_steady,
                            .exposure_us = frame.exposure_us};
  const GlobalTime arrived = by_arrivals_->stamp(sample);
  const GlobalTime stamp = readings_ < kFewestReadings ? arrived : by_readings_->stamp(sample);
  return SteadyTime(stamp.time_since_epoch());
}

ExposedFrame FrameClock::at(const FrameArrival& frame) {
  const SteadyTime exposed = frame.sensor_steady ? *frame.sensor_steady : estimated(frame);
  const bool used_readings = std::exchange(uses_readings_, readings_ >= kFewestReadings);
  return {.counter = frame.counter,
          .exposed = frame.arrival + (exposed - frame.arrival_steady),
          .exposed_steady = exposed,
          .arrival_steady = frame.arrival_steady,
          .arrival = frame.arrival,
          .exposure = Microseconds(frame.exposure_us),
          .has_new_source = uses_readings_ && !used_readings};
}

}  // namespace simbench
