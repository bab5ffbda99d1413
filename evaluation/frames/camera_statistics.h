// What the stamps of one camera's stream say of its two clocks: intervals, the difference of their
// rates, and the excess delay over the fastest frames.
//
// Values are in milliseconds of the named clock. A value that too few frames leave undefined is
// NaN; what makes a value doubtful is a line of doubts_of(). Stamps may be anything that a file
// holds: differences are exact before they become double, and cannot overflow.
//
// Complexity: O(n). Source: docs/reference/paper.md section 8, docs/reference/device_time.md
// sections 1 and 5; check values: tests/data/README.md (ibl: -215.385 ppm by least squares,
// -214.932 ppm by the lower envelope).
//
//   const CameraStatistics found = camera_statistics(unwrapped(recorded.streams[0].frames));
//   print(found.drift_ppm, found.excess.p99_ms);
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "algorithms/ports/time.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

struct PeriodStatistics {
  double mean_ms = 0;
  double sd_ms = 0;
};

// Deviations from a line or a stamp, less their mean; late is positive.
struct ResidualStatistics {
  double sd_ms = 0;
  double p95_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
};

// The delay of the arrivals over the lower envelope.
struct ExcessStatistics {
  double mean_ms = 0;
  double p50_ms = 0;
  double p95_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
};

struct CameraStatistics {
  std::int64_t frames = 0;
  std::int64_t long_intervals = 0;     // sensor intervals above 1.5 times their median
  std::int64_t backward_steps = 0;     // sensor stamps earlier than the preceding one
  std::int64_t backward_arrivals = 0;  // likewise
  double span_s = 0;                   // of the arrivals
  PeriodStatistics sensor_period;
  PeriodStatistics arrival_period;
  double drift_ppm = 0;           // (host rate / device rate - 1) 1e6, least squares
  double envelope_drift_ppm = 0;  // the same by the earliest frames of the first and last tenth
  ResidualStatistics residual;    // of the arrivals from the least-squares line
  ExcessStatistics excess;
};

// `frames`: unwrapped.
CameraStatistics camera_statistics(std::span<const StampedFrame> frames);

// Why numbers of the stream may be wrong, a line each that names the camera.
std::vector<std::string> doubts_of(const RecordedStream& stream);

// Returns the frames with sensor stamps that continue where the 32-bit microsecond register wraps
// (half range rule: late frames are no wrap). Stamps beyond the register's range stay as they are.
std::vector<StampedFrame> unwrapped(std::span<const StampedFrame> frames);

// Cameras are unsteady at first: so much of a recording that is long enough is left out.
inline constexpr Nanoseconds kUnsteadyStart = std::chrono::seconds(5);
inline constexpr Nanoseconds kLongRecording = std::chrono::seconds(20);
// Frames in order of delivery, at least one; by their arrivals.
std::span<const StampedFrame> without_unsteady_start(std::span<const StampedFrame> frames);

// Puts frames that were delivered after later ones (their stamps and counters go back by a few,
// arrivals do not) in order of their exposure; returns how many. `frames`: unwrapped.
std::int64_t put_in_order_of_exposure(std::vector<StampedFrame>& frames);

// Whether the stamps count from 1970, as those of a clock that is set: of a computer, of a camera
// under PTP, of librealsense's global time.
bool counts_from_1970(std::span<const StampedFrame> frames);

// Whether every frame arrived at its sensor stamp, as where a file has one column for both: there
// is one clock only, and no delay. False with fewer than two frames.
bool has_one_clock(std::span<const StampedFrame> frames);

// Beyond 1 %: stamps of another unit or of several cameras, or too few of them. False for NaN.
bool is_doubtful_drift(double ppm);

// Returns the median interval between sensor stamps; zero with fewer than two frames.
Nanoseconds median_period(std::span<const StampedFrame> frames);

// The stamps of a device_time on one stream.
struct StampStatistics {
  // Standard deviation of (interval of global stamps - interval of sensor stamps): the jitter of
  // the arrivals that the estimator passes on.
  double jitter_ms = 0;
  // Arrival minus global stamp: the delay by the estimator. NaN for relative stamps.
  ResidualStatistics residual;
  // (host rate / device rate - 1) 1e6 by least squares of its stamps over the sensor's; NaN for
  // relative stamps, which follow the device's rate.
  double drift_ppm = 0;
};

// `frames`: unwrapped, as many as there are stamps. `relative`: DeviceTimeEstimator::relative().
StampStatistics stamp_statistics(std::span<const StampedFrame> frames,
                                 std::span<const GlobalTime> stamps, bool relative);

// Exact before the conversion to double; cannot overflow.
double difference_ms(std::int64_t a_ns, std::int64_t b_ns);

}  // namespace simbench::evaluation
