// A camera's clock polls as a clean series, and the frames they are for.
//
// Built on offset_stream.h with the poll's end as its arrival. Left out are polls that end before
// they begin or take more than a second, and those not later on the camera than the newest.
#ifndef SIMBENCH_ALGORITHMS_DEVICE_TIME_POLL_STREAM_H_
#define SIMBENCH_ALGORITHMS_DEVICE_TIME_POLL_STREAM_H_

#include <cstdint>

#include "algorithms/device_time/offset_stream.h"

namespace simbench {

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

  // Of the poll pushed last: x its reading in us, y the offset of its end in ns, from kFirst's.
  LinePoint end() const { return stream_.point(); }
  std::int64_t round_trip_ns() const { return round_trip_ns_; }

  // The global stamp of a frame by offset(x) in ns, where x is its sensor stamp from kFirst's; its
  // arrival if there are no polls or the frame is of other clocks than they.
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

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_DEVICE_TIME_POLL_STREAM_H_
