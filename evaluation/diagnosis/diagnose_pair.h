// Two streams of one camera against each other, as depth and colour
// (evaluation/diagnosis/diagnose.h).
//
// Both have stamps of the camera's one clock. Each frame of the second stream is compared with the
// nearest of the first; the offsets are continued over half a period, so that a stream that runs
// free shows as a steady movement.
#ifndef SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_PAIR_H_
#define SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_PAIR_H_

#include <limits>
#include <span>
#include <string>

#include "recording/rs_csv.h"

namespace simbench::evaluation {

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

#endif  // SIMBENCH_EVALUATION_DIAGNOSIS_DIAGNOSE_PAIR_H_
