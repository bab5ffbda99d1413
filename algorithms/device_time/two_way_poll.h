// device_time from polls of the camera's clock: two-way convex hulls (MOOS, TICSync).
//
// A poll sent at t0 and answered at t1 read the camera's clock as d in between, so t0 - d and
// t1 - d bound the offset of the host's clock to the camera's from below and above. The upper hull
// of the lower bounds and the lower hull of the upper bounds are lines; the estimate is the mean of
// the two edges over the middle of the window, for any sensor stamp. Frames only bring stamps:
// their arrivals are not used, so delivery latency is not in the result, and load does not matter.
//
// Error: half of the difference of the least request and reply delay (asymmetry), which no two-way
// method can see; the hulls' noise as in hull.h, with the polls of the window for n. With 10 polls
// a second of 0.3 ms + Exp(0.1 ms) each way, a window of 20 s leaves 1.3 us, and 2.8 us under a
// skew that wanders by 5 ppm in 300 s; 10 s leave 2.5 and 2.6, 30 s leave 0.8 and 5.0.
//
// Before the first poll, and where a frame's arrival lies more than 1 s + 0.1 % of the time since
// the newest poll away from the line (its camera was restarted): the arrival. Polls that end before
// they begin, take more than a second or are not later on the camera than the newest are left out;
// a clock that was set or restarted forgets all polls before (offset_stream.h). Slopes are limited
// as in hull.h.
//
// Needs polls (Need::kPolls). Given the warm-up. Complexity: a poll O(vertices), a frame O(1).
// Memory: the polls of the window, at most kMaxPolls.
// Source: docs/reference/host_sync.md section 1 (two-way convex hull); Harrison, Newman: TICSync,
// 2011.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_TWO_WAY_POLL_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_TWO_WAY_POLL_H_

#include <cstddef>
#include <memory>

#include "algorithms/device_time/device_time.h"
#include "algorithms/device_time/hull.h"

namespace simbench {

struct TwoWayPollSettings {
  static constexpr std::size_t kMaxPolls = 4096;

  double window_s = 20;  // of device time, positive
  double max_skew_ppm = kDefaultMaxSkewPpm;
};

std::unique_ptr<DeviceTimeEstimator> make_two_way_poll(TwoWayPollSettings settings);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_TWO_WAY_POLL_H_
