// Recordings of real cameras through the stages that can be run again: device_time and gathering.
//
// host_sync cannot be replayed: it had its effect on the clocks that stamped the arrivals. Every
// registered device_time estimator is run that needs no truth, with its default parameters, on
// every stream of every camera. Streams of the same kind on two or more cameras are then compared:
// AMD and RMDV over the frames that GenLock order puts together, and over the sets of every
// registered gatherer. There is no ground truth in a recording:
//
//  - GenLock order (re-anchored) counts from each camera's first frame. It is right if all cameras
//    were started by one trigger pulse. First arrivals further apart than half a period contradict
//    that, nearer ones do not prove it (RigReplay::common_start_plausible).
//  - Sets of a gatherer are as good as the gatherer: scores over them are unverified.
//
// Stamps that are relative (they count from a camera's first frame) are given one common anchor,
// the earliest first arrival of the kind of stream.
//
// Complexity: linear in the frames, but for sorting them by arrival. Memory: a few hundred bytes a
// frame. Source: docs/design.md sections 2 and 8, docs/reference/paper.md section 8.
//
//   Replay replay = run_replay(reader.take());
#ifndef SIMBENCH_EVALUATION_REPLAY_REPLAY_H_
#define SIMBENCH_EVALUATION_REPLAY_REPLAY_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "algorithms/ports/time.h"
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

// Of values in any order; their mean is taken off first.
ResidualStatistics residual_statistics(std::vector<double> values);

// Exact before it becomes a double; cannot overflow.
double difference_ms(std::int64_t a_ns, std::int64_t b_ns);

// One estimator on one stream of one camera.
struct DeviceTimeReplay {
  std::string device_time;
  // Standard deviation of (interval of global stamps - interval of sensor stamps): what the
  // estimator lets through of the arrivals' jitter.
  double jitter_ms = 0;
  // Arrival minus global stamp: what the estimator takes for delay. NaN for relative stamps.
  ResidualStatistics residual;
  // (host rate / device rate - 1) 1e6 by least squares of its stamps over the sensor's; NaN for
  // relative stamps, which follow the device's rate.
  double drift_ppm = 0;
  std::vector<GlobalTime> stamps;  // of every frame
};

struct CameraReplay {
  std::string camera;
  std::string host;
  std::string stream;
  std::vector<StampedFrame> frames;  // sensor stamps unwrapped
  CameraStatistics statistics;
  std::vector<DeviceTimeReplay> rows;  // in order of registration
};

struct GatheringReplay {
  std::string gathering;
  std::int64_t sets = 0;
  std::int64_t discarded_frames = 0;
  double amd_ms = 0;
  double rmdv_ms = 0;
};

// One estimator over all cameras.
struct RigRow {
  std::string device_time;
  double amd_ms = 0;  // over the pulses that GenLock order finds complete
  double rmdv_ms = 0;
  std::vector<GatheringReplay> gatherings;
};

// The cameras that have one kind of stream.
struct RigReplay {
  std::string stream;
  std::vector<std::size_t> cameras;  // indices of Replay::cameras
  double period_ms = 0;              // median of the sensor intervals
  std::int64_t complete_pulses = 0;  // by GenLock order, delivered by all cameras
  double first_arrival_range_ms = 0;
  bool common_start_plausible = false;  // that range is below half a period
  std::vector<RigRow> rows;
};

struct Replay {
  std::vector<CameraReplay> cameras;
  std::vector<RigReplay> rigs;  // only where two cameras or more have a stream of that kind
  std::vector<std::string> warnings;
};

Replay run_replay(std::vector<CameraStream> streams);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_REPLAY_REPLAY_H_
