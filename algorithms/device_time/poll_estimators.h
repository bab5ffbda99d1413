// device_time over polls of the camera's clock, without the frames' arrivals: the series of polls,
// and the estimators on it. Both need polls (Need::kPolls).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "algorithms/device_time/device_time.h"
#include "algorithms/device_time/hull.h"
#include "algorithms/device_time/offset_stream.h"

namespace simbench {

// A camera's clock polls as a clean series, and the frames they are for.
//
// The poll's end takes the place of a sample's arrival (offset_stream.h). Polls that end before
// they begin, take more than a second or are not later on the camera than the newest are left out.
class PollStream {
 public:
  enum class Poll : std::uint8_t { kFirst, kNext, kLeftOut };

  Poll push(const PollSample& poll) {
    const Int128 round_trip_ns = Int128{nanoseconds_of(poll.t1)} - nanoseconds_of(poll.t0);
    if (round_trip_ns < 0 || round_trip_ns > kLongestNs) return Poll::kLeftOut;
    round_trip_ns_ = static_cast<std::int64_t>(round_trip_ns);
    switch (stream_.push({.sensor = poll.device,
                          .arrival = poll.t1,
                          .arrival_steady = poll.t1_steady,
                          .exposure_us = 0})) {
      case OffsetStream::Sample::kFirst:
        return Poll::kFirst;
      case OffsetStream::Sample::kNext:
        return Poll::kNext;
      case OffsetStream::Sample::kLate:
        break;
    }
    return Poll::kLeftOut;
  }

  bool empty() const { return stream_.empty(); }

  // The poll pushed last: x its reading in us, y the offset of its end in ns, from kFirst's.
  LinePoint end() const { return stream_.point(); }
  std::int64_t round_trip_ns() const { return round_trip_ns_; }

  // The global stamp of a frame by offset(x) in ns, where x is its sensor stamp from kFirst's. Its
  // arrival if there are no polls, or if one of the clocks was restarted since.
  template <class Offset>
  GlobalTime stamp(const DeviceSample& frame, Offset offset) const {
    if (!empty()) {
      const LinePoint arrival = OffsetStream::reachable(stream_.anchor().point(frame));
      if (stream_.continues(arrival)) {
        return stream_.anchor().stamp(frame.sensor, offset(arrival.x));
      }
    }
    return GlobalTime(frame.arrival.time_since_epoch());
  }

 private:
  static constexpr std::int64_t kLongestNs = 1'000'000'000;

  OffsetStream stream_;
  std::int64_t round_trip_ns_ = 0;
};

// Two-way convex hulls over polls (MOOS, TICSync).
//
// A poll sent at t0 with its reply at t1 read the camera's clock as d in between, so t0 - d and
// t1 - d bound the offset of the host's clock to the camera's from below and above. The estimate is
// the mean of two edges over the middle of the window: of the upper hull of the lower bounds and of
// the lower hull of the upper bounds. The frames' arrivals are not used, so delivery latency is not
// in the result, and load does not matter.
//
// Error: half the difference of the least request and reply delays (asymmetry), which no two-way
// method can measure; the hulls' noise as in hull.h, with n polls in the window. With 10 polls a
// second of 0.3 ms + Exp(0.1 ms) each way, a window of 20 s leaves 1.3 us, and 2.8 us under a skew
// that wanders by 5 ppm in 300 s; 10 s leave 2.5 and 2.6, 30 s leave 0.8 and 5.0.
//
// The stamp is the arrival before the first poll, and where the arrival lies more than 1 s + 0.1 %
// of the time since the newest poll away from the line (its camera was restarted). After a clock
// was set or restarted all older polls are discarded. Slopes are limited as in hull.h.
//
// Gets the warm-up. Complexity: a poll O(vertices), a frame O(1). Memory: the polls of the window,
// at most kMaxPolls.
// Source: docs/reference/host_sync.md section 1 (two-way convex hull); Harrison, Newman: TICSync,
// 2011.
struct TwoWayPollSettings {
  static constexpr std::size_t kMaxPolls = 4096;

  double window_s = 20;  // of device time, positive
  double max_skew_ppm = kDefaultMaxSkewPpm;

  void bind(ParameterBinder& parameters);
};

std::unique_ptr<DeviceTimeEstimator> make_two_way_poll(TwoWayPollSettings settings);

// librealsense's global time: its published algorithm over the recorded polls.
//
//   poll     every 100 ms until the window is full, then every second; earlier polls are left out
//            (5 % of the interval is tolerated)
//   sample   (d, y), y = t1 - d_min, d_min the least half round trip ever: all extra delay is
//            assumed to lie before the camera's reading. When d_min falls, the stored y move by
//            (new - old)
//   fit      least squares of y on d over the last 16 samples
//   blend    a new line replaces the one in use linearly over one second of device time
//
// The constants are librealsense's and therefore no parameters. Like TwoWayPoll it keeps half of
// the asymmetry, but reply delays and a late first poll also enter the fit: constant 0.3 ms out and
// 1.7 ms back give +0.700 ms exactly; a first poll that takes 20 ms longer, half each way, gives up
// to +9.9 ms within the first seconds (all in the request: twice that).
//
// Unlike librealsense: PollStream handles the frames before the first poll, bad polls and clocks
// that were set by more than a second (librealsense keeps such a step in the fit for 16 s; here
// only smaller ones stay); the fit is in exact integers, as librealsense's loses some microseconds
// within hours.
//
// Gets the warm-up. Complexity: a poll O(16), a frame O(1).
// Source: librealsense src/global_timestamp_reader.{h,cpp}; docs/reference/d455.md section 5.
std::unique_ptr<DeviceTimeEstimator> make_librealsense_global();

}  // namespace simbench
