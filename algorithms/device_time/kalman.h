// device_time by a Kalman filter of offset and skew, after KalmanOwt of cuckoo_time_translator.
//
//   x = [offset, skew],  F = [1 dt; 0 1],  Q = diag(0, skew_sigma^2) dt,  R = offset_sigma^2
//
// A frame whose residual exceeds `gate` standard deviations of the innovation is rejected. Such a
// gate locks itself out after a bad start: a first frame 24 ms late leaves all others rejected, and
// since Q adds nothing to the offset there is no way back (measured: 124 to 480 ms off for good).
// So after `rejections_to_restart` in a row the filter begins anew from the frame at hand.
//
// Delay is one-sided, so its mean within the gate stays in the stamps as a bias (0.28 ms for
// Exp(0.3 ms)). The defaults are the reference page's "tuned" row, not cuckoo's, whose cooldown and
// wide sigmas do worse on frames.
//
// First frame, and the first after a clock was set or restarted (offset_stream.h): its arrival; a
// frame not later than the newest is stamped from the state and not learned. O(1).
// Source: docs/reference/device_time.md section 1.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_KALMAN_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_KALMAN_H_

#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

struct KalmanSettings {
  double initial_offset_sigma_ms = 2;
  double initial_skew_sigma_ppm = 1000;
  double offset_sigma_ms = 0.3;  // of one arrival
  double skew_sigma_ppm = 2;     // random walk of the skew, per square root of a second
  double gate = 3;               // in standard deviations
  int rejections_to_restart = 10;
};

std::unique_ptr<DeviceTimeEstimator> make_kalman(KalmanSettings settings);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_KALMAN_H_
