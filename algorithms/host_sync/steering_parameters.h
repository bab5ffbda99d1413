// The parameters of clock_steering.h, as every algorithm that steers a clock by it declares them.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_STEERING_PARAMETERS_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_STEERING_PARAMETERS_H_

#include <vector>

#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/parameters.h"

namespace simbench {

std::vector<ParameterSpec> steering_parameters();
SteeringSettings steering_settings(const Parameters& parameters);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_STEERING_PARAMETERS_H_
