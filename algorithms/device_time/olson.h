// device_time by Olson's passive synchronisation: the offset may only grow by alpha a second, and
// falls at once to that of a frame that was delayed less.
//
//   est = q + (s - p) * (1 + alpha);  if est >= h: (p, q) = (s, h), est = h
//
// alpha must exceed the skew, or the estimate cannot follow; what exceeds it leaks into the stamps.
// Two numbers of state, O(1). A downward step of the host is followed at once, an upward one at
// alpha. First frame, and the first after a clock was set or restarted (offset_stream.h): its
// arrival; a frame not later than the newest is stamped and not learned..
//
// Source: Olson, A Passive Solution to the Sensor Synchronization Problem, IROS 2010;
// docs/reference/device_time.md section 1.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_OLSON_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_OLSON_H_

#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

struct OlsonSettings {
  double alpha_ppm = 50;
};

std::unique_ptr<DeviceTimeEstimator> make_olson(OlsonSettings settings);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_OLSON_H_
