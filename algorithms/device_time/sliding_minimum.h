// device_time by the sliding minimum: sensor stamp plus the least offset of the last W seconds of
// sensor time. The best of the simple methods.
//
// A skew of r leaves up to r * W; a downward step of the host is followed at once, an upward one
// after W. First frame, and the first after a clock was set or restarted (offset_stream.h): its
// arrival; a frame not later than the newest is stamped and not learned..
//
// Complexity: amortised O(1) with a queue of increasing offsets. It holds at most kMaxQueued; if
// offsets keep increasing for longer than that within W, the newest takes the place of the one
// before, which can only matter W later, by what lies between two frames.
//
// Source: docs/reference/device_time.md section 1.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_SLIDING_MINIMUM_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_SLIDING_MINIMUM_H_

#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

struct SlidingMinimumSettings {
  double window_s = 1;  // positive
};

std::unique_ptr<DeviceTimeEstimator> make_sliding_minimum(SlidingMinimumSettings settings);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_SLIDING_MINIMUM_H_
