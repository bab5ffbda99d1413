// device_time as librealsense's global time does it: its published algorithm over the recorded
// polls of the camera's clock.
//
//   poll     every 100 ms until the window is full, then every second; of the polls given, those
//            that come too early for this are left out (5 % of the interval is tolerated)
//   sample   (d, y), y = t1 - d_min, d_min the least half round trip ever: all extra delay is taken
//            to lie before the camera's reading. When d_min falls, the stored y move by (new - old)
//   fit      least squares of y on d over the last 16 samples
//   blend    a new line replaces the one in use linearly over one second of device time
//
// The constants are librealsense's and therefore no parameters. Compared with two_way_poll.h it
// keeps half of the asymmetry too, but also takes reply delays and a late first poll into the fit:
// constant 0.3 ms out and 1.7 ms back give +0.700 ms exactly; a first poll that takes 20 ms longer,
// half each way, gives up to +9.9 ms within the first seconds (all in the request: twice that).
//
// Ours, not librealsense's: before the first poll, and for a frame of other clocks than the polls,
// the arrival; bad polls and clocks that were set by more than a second as in poll_stream.h (there,
// such a step stays in the fit for 16 s; here smaller ones do); the fit is in exact integers, as
// theirs loses some microseconds within hours.
//
// Needs polls (Need::kPolls). Given the warm-up. Complexity: a poll O(16), a frame O(1).
// Source: librealsense src/global_timestamp_reader.{h,cpp}; docs/reference/d455.md section 5.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_LIBREALSENSE_GLOBAL_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_LIBREALSENSE_GLOBAL_H_

#include <memory>

#include "algorithms/device_time/device_time.h"

namespace simbench {

std::unique_ptr<DeviceTimeEstimator> make_librealsense_global();

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_LIBREALSENSE_GLOBAL_H_
