#include "algorithms/capture_alignment/frame_clock.h"

#include "algorithms/device_time/hull.h"

namespace simbench {

FrameClock::FrameClock() : estimator_(make_switching_hull(SwitchingHullSettings{})) {}

// The estimator knows one clock of a host, which here is the steady one.
SteadyTime FrameClock::estimated(const FrameArrival& frame) {
  const GlobalTime stamp =
      estimator_->stamp({.sensor = unwrapper_.unwrap(frame.sensor),
                         .arrival = HostTime(frame.arrival_steady.time_since_epoch()),
                         .arrival_steady = frame.arrival_steady,
                         .exposure_us = frame.exposure_us});
  return SteadyTime(stamp.time_since_epoch());
}

ExposedFrame FrameClock::at(const FrameArrival& frame) {
  const SteadyTime exposed = frame.sensor_steady ? *frame.sensor_steady : estimated(frame);
  return {.counter = frame.counter,
          .exposed = frame.arrival + (exposed - frame.arrival_steady),
          .exposed_steady = exposed,
          .arrival_steady = frame.arrival_steady};
}

}  // namespace simbench
