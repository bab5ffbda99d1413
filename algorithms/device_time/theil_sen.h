// device_time by Theil-Sen regression over the last n frames: the slope is the median of the slopes
// of all pairs, the level the median of the residuals.
//
// Robust against outliers; of one-sided delay its bias is about the median instead of the mean.
// A refit takes O(n^2), 45,000 slopes of 300 frames, so there is one every n/20 frames (each frame,
// while the window holds fewer than 40); in between frames are stamped from the last line.
// Memory: n frames and n^2/2 slopes.
//
// First frame, and the first after a clock was set or restarted (offset_stream.h): its arrival; a
// frame not later than the newest is stamped and not learned..
// Source: Sen 1968; docs/reference/device_time.md section 1 (refit every 15 of 300 frames there
// too).
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_THEIL_SEN_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_THEIL_SEN_H_

#include <cstddef>
#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

struct TheilSenWindow {
  std::size_t frames = 300;  // 1 to 10,000
};

std::unique_ptr<DeviceTimeEstimator> make_theil_sen(TheilSenWindow window);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_THEIL_SEN_H_
