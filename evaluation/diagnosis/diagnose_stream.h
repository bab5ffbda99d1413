// What the stamps of one stream of one camera say by themselves, and those of two streams together
// (evaluation/diagnosis/diagnose.h).
//
// Where the arrivals run on but the sensor stamps jump against them, or the other way round, for
// good, that is a jump: of whole periods (the camera's stamps slipped) or of any length (a clock
// was set). Arrivals are compared with jumps taken out.
//
// The first 5 s are left out of recordings of 20 s and more: cameras are unsteady there.
#ifndef SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_STREAM_H_
#define SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_STREAM_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "recording/rs_csv.h"

namespace simbench::evaluation {

// A lasting change of (arrival - sensor stamp).
struct StampJump {
  std::size_t frame = 0;  // the first one after it; of StreamFacts::arrivals_ms
  double at_s = 0;        // after the stream's first arrival
  double step_ms = 0;     // positive: stamps fell behind the arrivals
  int periods = 0;        // 0: no whole number of them
};

struct StreamFacts {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::int64_t frames = 0;  // all
  double first_arrival_s = kUnknown;
  double last_arrival_s = kUnknown;
  double longest_gap_s = kUnknown;  // between two arrivals
  double gap_at_s = kUnknown;       // its begin, after the first arrival
  // On the camera's clock.
  double period_ms = kUnknown;           // of a frame
  double interval_jitter_ms = kUnknown;  // standard deviation from whole periods
  double on_grid_share = kUnknown;       // of intervals within a tenth of whole periods
  // On the host's clock.
  double host_period_ms = kUnknown;
  double host_period_sd_ppm = kUnknown;  // standard deviation of that, relative
  // Events.
  std::int64_t lost_frames = 0;       // counted by the camera, never arrived
  std::int64_t skipped_pulses = 0;    // periods without a frame that the counter does not know
  std::int64_t counter_restarts = 0;  // the counter stood still or went back
  std::int64_t backward_stamps = 0;
  std::int64_t backward_arrivals = 0;
  std::int64_t future_stamps = 0;  // frames that arrived earlier than their stamp allows
  double future_ms = 0;            // by how much, at most
  std::int64_t wraps = 0;          // of the 32-bit microsecond register
  std::vector<StampJump> jumps;
  // Arrivals with jumps taken out, and the period each belongs to; for comparisons of phase.
  std::vector<double> arrivals_ms;
  std::vector<std::int64_t> periods;

  double span_s() const { return last_arrival_s - first_arrival_s; }
};

// `frames` as recorded, not unwrapped, in order of delivery.
StreamFacts stream_facts(std::span<const StampedFrame> frames);

// Two streams of one camera against each other, as depth and colour.
//
// Both have stamps of the camera's one clock. Each frame of the second stream is compared with the
// nearest of the first; the offsets are continued over half a period, so that a stream that runs
// free shows as a steady movement.
struct PairDiagnosis {
  std::string camera;
  std::string stream;
  std::string against;
  double offset_ms = std::numeric_limits<double>::quiet_NaN();  // mean; later is positive
  double spread_ms = std::numeric_limits<double>::quiet_NaN();  // sd about the movement
  double moves_ms_per_minute = std::numeric_limits<double>::quiet_NaN();
  bool runs_free = false;
};

// Both as recorded, with two frames or more; offsets and movement are NaN with fewer.
PairDiagnosis compare_streams(std::span<const StampedFrame> frames,
                              std::span<const StampedFrame> against);

}  // namespace simbench::evaluation

#endif  // SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_STREAM_H_
