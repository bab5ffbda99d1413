// The device_time algorithms by other models of the two clocks, as the registry lists them:
// passive synchronisation, sliding minimum, Theil-Sen, Kalman, librealsense.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_CLOCK_MODELS_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_CLOCK_MODELS_H_

#include <vector>

#include "algorithms/registry.h"

namespace simbench {

std::vector<DeviceTimeEntry> clock_model_device_times();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_REGISTRATION_CLOCK_MODELS_H_
