// device_time without any: the arrival on the system clock is the global stamp (R4).
//
// The baseline that every estimator must beat: it keeps the full jitter and latency of delivery.
// Source: docs/reference/paper.md section 3 (R4).
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_RAW_ARRIVAL_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_RAW_ARRIVAL_H_

#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

std::unique_ptr<DeviceTimeEstimator> make_raw_arrival();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_RAW_ARRIVAL_H_
