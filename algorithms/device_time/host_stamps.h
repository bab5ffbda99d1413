// device_time of cameras that stamp with their host's steady clock: phones, and cameras that are
// computers themselves. Needs Need::kHostStamps.
//
// Nothing has to be estimated. The frame's stamp and its arrival are two readings of one clock, and
// the arrival is also one of the system clock:
//
//   stamp = arrival - (arrival_steady - sensor)
//
// `sensor` is the steady time for which the register stands (age_of(), ports/time.h), as long as
// the frame arrived within half of the register's range, 35 min, of it. Delivery latency and its
// jitter are not in the result, nor is any oscillator of the camera's.
//
// Error: the resolution of the stamps; the system clock's slew from the exposure to the arrival
// (500 ppm over 50 ms are 25 ns); a step of the system clock in that time counts in full, which the
// variant _steady removes (variants.h). Results saturate at 64 bits.
//
// Holds no state: O(1) a frame. Source: arithmetic; docs/reference/capture_alignment.md section 8
// (SENSOR_TIMESTAMP of the source REALTIME).
//
//   auto estimator = make_host_stamps();
//   GlobalTime exposed = estimator->stamp(sample);
#pragma once

#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

std::unique_ptr<DeviceTimeEstimator> make_host_stamps();

}  // namespace simbench
