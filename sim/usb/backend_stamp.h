// The back-end stamp of a frame: what librealsense makes of the kernel's stamp.
//
// The kernel stamps the frame on the host's monotonic clock (here its steady clock). When the SDK
// has the frame, it moves that stamp to the system clock by the difference of both clocks, each cut
// to the SDK's resolution, and cuts the result:
//
//   stamp = cut(m + cut(system) - cut(monotonic))
//
// On Windows m, in ms since the host was switched on, goes through a 32-bit float, whose 24 bits
// are steps of 0.4 ms after an hour and of 8 ms after a day. Intervals of back-end stamps thus
// fluctuate far more than those of arrivals, as in Fig. 2 of Yoon et al. 2021, whose hosts have
// Windows 10. Elsewhere, and on Windows since 2025, m is the monotonic clock itself.
//
// All of a frame's delay after its transfer is taken to lie before the kernel's stamp, since the
// paper ascribes the big jumps to the transmission from the camera to the host; that drivers stamp
// a frame's first packet shifts all stamps alike. There is nothing random in it, and no other stamp
// depends on it.
//
// Source: librealsense src/backend.cpp (monotonic_to_realtime), src/mf/mf-uvc.cpp (OnReadSample)
// until pull request #13997; docs/reference/d455.md section 1.
//
//   const BackendStamps stamps(scenario.usb.backend_stamp, Granularity(from_ms(0.001)));
//   const SystemClock::Reading reading = system_clock.read_both(now);
//   const SteadyTime switched_on = system_clock.steady(capture_start);
//   const HostTime backend = stamps.stamp(system_clock, switched_on, copied, reading);
#pragma once

#include <optional>

#include "algorithms/ports/time.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/clock/clock_interface.h"
#include "sim/clock/system_clock.h"

namespace simbench::sim {

class BackendStamps {
 public:
  // Without settings a stamp is the system clock at `copied` in steps of `arrival_quantum`.
  BackendStamps(const std::optional<scenarios::BackendStamp>& settings,
                Granularity arrival_quantum);

  // A stamp of a host with this clock, switched on host_uptime_h before its steady clock read
  // `capture_start`. `copied`: when the transfer has ended and the frame is copied, without delays;
  // `delivered`: both clocks at that instant.
  HostTime stamp(const SystemClock& clock, SteadyTime capture_start, TrueTime copied,
                 const SystemClock::Reading& delivered) const {
    return is_converted_ ? converted(capture_start, delivered)
                         : resolution_.round_down(clock.read(copied));
  }

 private:
  HostTime converted(SteadyTime capture_start, const SystemClock::Reading& delivered) const;

  bool is_converted_;
  Nanoseconds uptime_{};  // 0: no float
  Granularity resolution_;
};

// Milliseconds since the host was switched on, as a 32-bit float has them.
Nanoseconds through_float_ms(Nanoseconds since_boot);

}  // namespace simbench::sim
