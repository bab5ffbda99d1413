// Recordings of real cameras through the stages that can run again: device_time and gathering.
//
// host_sync cannot be replayed: it had its effect on the clocks that stamped the arrivals. Every
// registered device_time estimator that needs no truth runs with its default parameters on every
// stream of every camera, except those that need polls of the cameras' clocks, which these
// recordings do not have. Streams of the same kind on two or more cameras are then compared: AMD
// and RMDV over the frames that GenLock order puts together, and over the sets of every registered
// gatherer. A recording has no ground truth:
//
//  - GenLock order (re-anchored) counts from each camera's first frame. It is right if one trigger
//    pulse started all cameras. First arrivals further apart than half a period contradict that,
//    nearer ones do not prove it (RigReplay::common_start_plausible).
//  - Sets of a gatherer are as good as the gatherer: scores over them are unverified.
//
// Relative stamps (they count from a camera's first frame) get one common anchor, the earliest
// first arrival of the kind of stream.
//
// Statistics of one camera: intervals, the frequency difference of the two clocks, and the excess
// delay over the fastest frames, in milliseconds of the named clock. A value that too few frames
// leave undefined is NaN. What makes a value doubtful is a warning.
//
// Complexity: linear in the frames, except for sorting them by arrival. Estimators run beside each
// other, fewer of them with more frames. Memory: 24 bytes a frame, and 24 more for each estimator
// that runs (48 while one learns the whole recording). Source: docs/design.md sections 2 and 8,
// docs/reference/paper.md section 8, docs/reference/device_time.md sections 1 and 5; check values:
// tests/data/README.md (ibl: -215.385 ppm by least squares, -214.932 ppm by the lower envelope).
//
//   Replay replay = run_replay(reader.take());
//   CameraStatistics s = camera_statistics(unwrapped(stream));
#ifndef SIMBENCH_EVALUATION_REPLAY_REPLAY_H_
#define SIMBENCH_EVALUATION_REPLAY_REPLAY_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algorithms/device_time/device_time.h"
#include "algorithms/ports/time.h"
#include "algorithms/registry.h"
#include "evaluation/run/evaluate.h"
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
  std::int64_t missing_frames = 0;     // by gaps of the frame counter, without its jumps
  std::int64_t counter_jumps = 0;      // gaps of more frames than the time between two allows
  std::uint64_t largest_jump = 0;      // of the counter
  std::int64_t counter_restarts = 0;   // it stood still or went back
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

// Returns the frames with sensor stamps that continue where the 32-bit microsecond register wraps
// (half range rule: late frames are no wrap). Stamps beyond the register's range stay as they are.
std::vector<StampedFrame> unwrapped(std::span<const StampedFrame> frames);
void unwrap(std::vector<StampedFrame>& frames);  // the same in place

// Whether a counter that went up by `step` between two frames counted them: no more than fit twice
// into the time between, and some. More is a jump.
bool is_counter_gap(std::uint64_t step, const StampedFrame& before, const StampedFrame& now,
                    double period_ms);

// Whether the stamps count from 1970, as those of global time do and no camera's.
bool counts_from_1970(std::span<const StampedFrame> frames);

// Beyond 1 %: stamps of another unit or of several cameras, or too few of them. False for NaN.
bool is_doubtful_drift(double ppm);

// O(n). `frames`: unwrapped.
CameraStatistics camera_statistics(std::span<const StampedFrame> frames);

// Returns the median interval between sensor stamps; zero with fewer than two frames.
Nanoseconds median_period(std::span<const StampedFrame> frames);

// `values`: in any order; their mean is subtracted first.
ResidualStatistics residual_statistics(std::vector<double> values);

// Exact before the conversion to double; cannot overflow.
double difference_ms(std::int64_t a_ns, std::int64_t b_ns);

// One estimator on one stream of one camera.
struct DeviceTimeReplay {
  std::string device_time;
  bool needs_polls = false;  // it did not run, and all values are NaN
  // Standard deviation of (interval of global stamps - interval of sensor stamps): the jitter of
  // the arrivals that the estimator passes on.
  double jitter_ms = 0;
  // Arrival minus global stamp: the delay by the estimator. NaN for relative stamps.
  ResidualStatistics residual;
  // (host rate / device rate - 1) 1e6 by least squares of its stamps over the sensor's; NaN for
  // relative stamps, which follow the device's rate.
  double drift_ppm = 0;
};

struct CameraReplay {
  std::string camera;
  std::string host;
  std::string stream;
  std::vector<StampedFrame> frames;  // sensor stamps unwrapped
  Nanoseconds anchor{};              // of relative stamps
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
  bool needs_polls = false;  // as DeviceTimeReplay
  double amd_ms = 0;         // over the pulses that GenLock order finds complete
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

// `progress` counts stamps of long recordings, on any thread, one call at a time; what it throws
// ends the replay.
Replay run_replay(std::vector<CameraStream> streams, const Progress& progress = {});

// One estimator on one camera, with its default parameters. Neither may need polls nor truth.
class CameraEstimator {
 public:
  // `camera` must outlive this. An offline estimator learns the recording here.
  CameraEstimator(const DeviceTimeEntry& entry, const CameraReplay& camera);
  // Of the next frame.
  GlobalTime stamp(const StampedFrame& frame);
  bool relative() const { return estimator_->relative(); }

 private:
  std::unique_ptr<DeviceTimeEstimator> estimator_;
  Nanoseconds shift_{};
};

// The global stamps of a camera of a replay, computed anew: there are too many to keep them.
class GlobalStamps {
 public:
  // `camera` must outlive this.
  explicit GlobalStamps(const CameraReplay& camera);
  // Of the next frame, one for each of the camera's rows; nothing for one that needs polls.
  const std::vector<std::optional<GlobalTime>>& next();

 private:
  const CameraReplay& camera_;
  std::size_t frame_ = 0;
  std::vector<std::optional<CameraEstimator>> estimators_;
  std::vector<std::optional<GlobalTime>> stamps_;
};

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_REPLAY_REPLAY_H_
