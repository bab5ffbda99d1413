// What one camera's recorded stamps say about the camera, its clock and its host.
//
// No truth is needed for it: intervals, the frequency difference of the two clocks, and how much
// longer than the fastest frames the others took. All in milliseconds of the clock that is named.
//
// Source: docs/reference/device_time.md sections 1 and 5; check values: tests/data/README.md
// (ibl: -215.385 ppm by least squares, -214.932 ppm by the lower envelope).
//
//   CameraStatistics s = camera_statistics(unwrapped(stream));
#ifndef SIMBENCH_EVALUATION_REPLAY_REPLAY_CAMERA_H_
#define SIMBENCH_EVALUATION_REPLAY_REPLAY_CAMERA_H_

#include <cstdint>
#include <span>
#include <vector>

#include "recording/rs_csv.h"

namespace simbench::evaluation {

struct PeriodStatistics {
  double mean_ms = 0;
  double sd_ms = 0;
};

// Deviations from a line or from a stamp, their mean taken off; the late side is positive.
struct ResidualStatistics {
  double sd_ms = 0;
  double p95_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
};

// How much later than the lower envelope the frames arrived.
struct ExcessStatistics {
  double mean_ms = 0;
  double p50_ms = 0;
  double p95_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
};

// A quantity that too few frames leave undefined is NaN.
struct CameraStatistics {
  std::int64_t frames = 0;
  std::int64_t missing_frames = 0;  // by gaps of the frame counter
  std::int64_t long_intervals = 0;  // sensor intervals above 1.5 times their median
  std::int64_t backward_steps = 0;  // sensor stamps before the one before
  double span_s = 0;                // of the arrivals
  PeriodStatistics sensor_period;
  PeriodStatistics arrival_period;
  double drift_ppm = 0;           // (host rate / device rate - 1) 1e6, least squares
  double envelope_drift_ppm = 0;  // the same by the earliest frames of the first and last tenth
  ResidualStatistics residual;    // of the arrivals from the least-squares line
  ExcessStatistics excess;
};

// The frames with sensor stamps that go on where the 32-bit microsecond register starts again
// (half- range rule: late frames are no wrap). Stamps beyond the register's range are taken as they
// are.
std::vector<StampedFrame> unwrapped(std::span<const StampedFrame> frames);

// O(n). `frames` are unwrapped.
CameraStatistics camera_statistics(std::span<const StampedFrame> frames);

// The median of the intervals between sensor stamps; zero with fewer than two frames.
Nanoseconds median_period(std::span<const StampedFrame> frames);

// The least-squares line of y over x, about the mean of x: numerically sound for any zero of x.
struct FittedLine {
  double slope = 0;  // NaN with fewer than two different x
  double mean_x = 0;
  double mean_y = 0;
  double at(double x) const { return mean_y + slope * (x - mean_x); }
};
FittedLine fit_line(std::span<const double> x, std::span<const double> y);

// Of values in any order; their mean is taken off first.
ResidualStatistics residual_statistics(std::vector<double> values);

// Exact before it becomes a double; cannot overflow.
double difference_ms(std::int64_t a_ns, std::int64_t b_ns);

double mean_of(std::span<const double> values);
// Of the population the values are a sample of (divisor n - 1); NaN with fewer than two.
double standard_deviation(std::span<const double> values);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_REPLAY_REPLAY_CAMERA_H_
