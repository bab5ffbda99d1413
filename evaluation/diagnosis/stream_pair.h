// Two streams of one camera compared, such as depth and colour.
//
// Both have stamps of the camera's one clock. Each frame of the second stream is compared with the
// nearest of the first; offsets are continued beyond half a period, so that a free-running stream
// shows as a steady drift.
//
//   PairDiagnosis pair = compare_streams(recorded.streams[1].frames, recorded.streams[0].frames);
//
// Complexity: O(n).
#pragma once

#include <span>
#include <string>

#include "evaluation/statistics/statistics.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

struct PairDiagnosis {
  std::string camera;
  std::string stream;
  std::string against;
  double offset_ms = kNan;  // mean; later is positive
  double spread_ms = kNan;  // sd about the movement
  double moves_ms_per_minute = kNan;
  bool runs_free = false;
};

// Both as recorded; offset and drift are NaN with fewer than two frames in either.
PairDiagnosis compare_streams(std::span<const StampedFrame> frames,
                              std::span<const StampedFrame> against);

}  // namespace simbench::evaluation
