// device_time of the paper: the readings of eq. (1) (R0 to R4), and the GenLock ground truth's.
//
// Source: Yoon et al. 2021, eq. (1); docs/reference/paper.md sections 3, 5 and 8.
//
//   auto estimator = make_regression({.frames = 30});
//   GlobalTime stamp = estimator->stamp(sample);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

// Linear regression of arrival on sensor stamp: eq. (1) read as base-sample regression (R3), the
// reading that averages arrival jitter down. The default.
//
//   t_g = slope * (t_s - t_s[0]) + intercept + t_h[0]
//
// The fit is of the offset arrival - sensor over the sensor stamp, which is the same line with
// small numbers. Online, over the last n frames including the current one (until n exist, all so
// far); expanding, over all frames so far; offline, over all frames of the recording.
//
// Properties: white arrival noise of standard deviation sigma leaves 2*sigma/sqrt(n) in an online
// stamp; a constant latency stays in the stamp, as it does in every one-way method. Fewer than two
// frames, or all with one sensor stamp: sensor stamp plus the mean offset. Decreasing stamps are
// points like any others. Stamps stay finite and within 64 bits for any input.
//
// Arrivals are on the system clock. O(1) and no allocation per frame. Sums are exact (line_fit.h)
// or of deviations from the mean, so hours cost no precision.
//
// Source: docs/reference/paper.md section 3 (R3); docs/reference/device_time.md section 2.
struct RegressionWindow {
  std::size_t frames = 30;  // at least 1
};

std::unique_ptr<DeviceTimeEstimator> make_regression(RegressionWindow window);
std::unique_ptr<DeviceTimeEstimator> make_expanding_regression();
// Must be given the recording with learn() before the first stamp().
std::unique_ptr<DeviceTimeEstimator> make_offline_regression();

// Eq. (1) of the paper in its interval readings: as printed (R0), and with the coefficients in the
// right order on the previous (R1) or the current (R2) host stamp.
//
// With dx the intervals of the sensor stamps and dy those of the arrivals, least squares over the
// last n intervals including the current one gives dy = slope*dx + intercept. Then
//
//   R0  intercept*dx + slope + t_h[i]       as printed: a and b swapped, in milliseconds
//   R1  slope*dx + intercept + t_h[i-1]     one-frame prediction; keeps the full arrival jitter
//   R2  slope*dx + intercept + t_h[i]       R1 and one frame period of bias
//
// R0 is nonsense by construction (dx is nearly constant, so the fit is ill-conditioned) and is kept
// to show it; its correction is limited to +-1e17 ns so that stamps stay finite and differences of
// two of them fit 64 bits. Fewer than two intervals, or all alike: slope 1, intercept
// mean(dy - dx). The first frame of a camera has no interval: its arrival is its stamp.
//
// Arrivals are on the system clock. O(1) and no allocation per frame.
// Source: docs/reference/paper.md section 3.
enum class Equation1Reading : std::uint8_t {
  kPrinted,           // R0
  kIntervalPrevious,  // R1
  kIntervalCurrent,   // R2
};

// `intervals` is n, at least 1.
std::unique_ptr<DeviceTimeEstimator> make_equation1(Equation1Reading reading,
                                                    std::size_t intervals = 30);

// No estimation: the arrival on the system clock is the global stamp (R4).
//
// The baseline that every estimator must beat: it keeps the full jitter and latency of delivery.
// Source: docs/reference/paper.md section 3 (R4).
std::unique_ptr<DeviceTimeEstimator> make_raw_arrival();

// The stamps of the GenLock ground truth: the sensor stamp minus the camera's first sensor stamp.
//
// All cameras start with one common trigger pulse, so these stamps count from one instant; they are
// relative() and depend on no host. Each still runs at its own camera's rate: 20 ppm of difference
// is 20 us per second. A camera that loses its first frame is off by a period.
// Source: docs/reference/paper.md sections 5 and 8.
std::unique_ptr<DeviceTimeEstimator> make_sensor_normalised();

}  // namespace simbench
