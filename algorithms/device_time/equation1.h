// device_time by eq. (1) of the paper in its interval readings: as printed (R0), and with the
// coefficients the right way round on the previous (R1) or the current (R2) host stamp.
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
// Arrivals are those on the system clock. O(1) and no allocation per frame.
// Source: docs/reference/paper.md section 3.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_EQUATION1_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_EQUATION1_H_

#include <cstddef>
#include <cstdint>
#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

enum class Equation1Reading : std::uint8_t {
  kPrinted,           // R0
  kIntervalPrevious,  // R1
  kIntervalCurrent,   // R2
};

// `intervals` is n, at least 1.
std::unique_ptr<DeviceTimeEstimator> make_equation1(Equation1Reading reading,
                                                    std::size_t intervals = 30);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_EQUATION1_H_
