// device_time of the GenLock ground truth: the sensor stamp minus the camera's first sensor stamp.
//
// All cameras start with one common trigger pulse, so these stamps count from one instant; they are
// relative() and know nothing of any host. Each still runs at its own camera's rate: 20 ppm of
// difference is 20 us per second. A camera that loses its first frame is off by a period.
// Source: docs/reference/paper.md sections 5 and 8.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_SENSOR_NORMALISED_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_SENSOR_NORMALISED_H_

#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

std::unique_ptr<DeviceTimeEstimator> make_sensor_normalised();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_SENSOR_NORMALISED_H_
