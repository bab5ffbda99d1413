// simbench's own device_time algorithms, as the registry lists them.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<DeviceTimeEntry> builtin_device_time_algorithms();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_H_
