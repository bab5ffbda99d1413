// device_time by linear regression of arrival on sensor stamp: eq. (1) read as base-sample
// regression (R3), the reading that averages arrival jitter down. The default.
//
//   t_g = slope * (t_s - t_s[0]) + intercept + t_h[0]
//
// Fitted is the offset arrival - sensor over the sensor stamp, which is the same line with small
// numbers. Online, over the last n frames including the current one (until n exist, all so far);
// expanding, over all frames so far; offline, over all frames of the recording.
//
// Properties: white arrival noise of standard deviation sigma leaves 2*sigma/sqrt(n) in an online
// stamp; a constant latency stays in the stamp, as it does in every one-way method. Fewer than two
// frames, or all with one sensor stamp: sensor stamp plus the mean offset. Decreasing stamps are
// points like any others. Stamps stay finite and within 64 bits for any input.
//
// Arrivals are those on the system clock. O(1) and no allocation per frame. Sums are exact
// (line_fit.h) or of deviations from the mean, so hours cost no precision.
//
// Source: docs/reference/paper.md section 3 (R3); docs/reference/device_time.md section 2.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_REGRESSION_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_REGRESSION_H_

#include <cstddef>
#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

struct RegressionWindow {
  std::size_t frames = 30;  // at least 1
};

std::unique_ptr<DeviceTimeEstimator> make_regression(RegressionWindow window);
std::unique_ptr<DeviceTimeEstimator> make_expanding_regression();
// Must be given the recording with learn() before the first stamp().
std::unique_ptr<DeviceTimeEstimator> make_offline_regression();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_REGRESSION_H_
