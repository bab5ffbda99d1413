// The device_time algorithms by convex hulls, of frames and of polls, as the registry lists them.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_HULL_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_HULL_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<DeviceTimeEntry> hull_device_times();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_HULL_H_
