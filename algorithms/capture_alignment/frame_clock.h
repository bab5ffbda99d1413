// When was this frame exposed, on the system clock of its host?
//
// One object per camera, which gets its frames in order of delivery. The answer is for algorithms
// that steer the camera while it runs, so it uses the past only:
//
//   camera stamps with the host's steady clock   the stamp
//   the host reads the camera's own clock        the two-way hulls of these readings
//                                                (poll_estimators.h), on the host's steady clock
//   neither                                      the switching hull (hull.h) of the arrivals, on
//                                                the host's steady clock
//
// and the steady time becomes system time by the frame's own arrival, which was read on both
// clocks. A step or a slew of the system clock therefore does not spoil the fit, and the next
// frame's stamp is by the clock as it was set.
//
// A stamp by readings is off by half of what a request takes longer than its reply, one by arrivals
// is late by the least time from the middle of an exposure to its arrival. That is a constant of
// the camera model and is not taken off here: it is the same for all cameras of one model, so it
// moves them all alike. Where readings take over from arrivals, stamps step by that: has_new_source
// tells. The first frames have little to fit; their error falls with the number of frames (hull.h).
//
// Complexity a frame and memory: those of the switching hull. Source: the same.
//
//   FrameClock frame_clock;
//   const HostTime exposed_at = frame_clock.at(FrameArrival{}).exposed;
#pragma once

#include <cstdint>
#include <memory>

#include "algorithms/device_time/device_time.h"
#include "algorithms/device_time/unwrap.h"
#include "algorithms/ports/host.h"

namespace simbench {

// A frame with the middle of its exposure.
struct ExposedFrame {
  std::uint32_t counter = 0;
  HostTime exposed{};
  SteadyTime exposed_steady{};
  SteadyTime arrival_steady{};
  HostTime arrival{};
  Nanoseconds exposure{};       // its time
  bool has_new_source = false;  // the first by readings, after some by arrivals
};

class FrameClock {
 public:
  FrameClock();
  ExposedFrame at(const FrameArrival& frame);

 private:
  SteadyTime estimated(const FrameArrival& frame);

  DeviceStampUnwrapper unwrapper_;
  std::unique_ptr<DeviceTimeEstimator> by_arrivals_;
  std::unique_ptr<DeviceTimeEstimator> by_readings_;
  std::uint32_t readings_ = 0;
  bool uses_readings_ = false;
};

}  // namespace simbench
