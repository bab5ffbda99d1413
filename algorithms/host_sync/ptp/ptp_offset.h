// From PTP's stamps to the offset that a servo is fed.
//
// End to end: a Sync leaves the master at t1 and reaches the slave at t2, a Delay_Req leaves at t3
// and reaches the master at t4; delay = ((t2 - t3) + (t4 - t1)) / 2 with the last Sync before it.
// Peer delay: request t1 to t2, response t3 to t4; delay = ((t4 - t1) - (t3 - t2)) / 2.
// The delay is the median of the last 10; offset = t2 - t1 - delay, slave minus master.
//
// All stamps in nanoseconds, corrections of transparent clocks already taken out; the clocks' rates
// are taken as equal within a delay measurement.
// Source: IEEE 1588-2008 clause 11; docs/reference/host_sync.md section 1 (linuxptp, tsproc.c).
//
//   PtpOffset filter(10);
//   filter.add_sync(t1, t2);
//   filter.add_request(t3, t4);
//   std::optional<Nanoseconds> offset = filter.offset();
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_OFFSET_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_OFFSET_H_

#include <cstddef>
#include <cstdint>
#include <optional>

#include "algorithms/host_sync/ptp/moving_median.h"

namespace simbench {

class PtpOffset {
 public:
  struct Sync {
    std::int64_t t1 = 0;
    std::int64_t t2 = 0;
  };

  explicit PtpOffset(std::size_t median_length) : median_(median_length) {}

  void add_sync(std::int64_t t1, std::int64_t t2) { sync_ = Sync{t1, t2}; }
  // Ignored without a Sync.
  void add_request(std::int64_t t3, std::int64_t t4) {
    if (!sync_) return;
    delay_ = median_.add(Nanoseconds((sync_->t2 - t3) / 2 + (t4 - sync_->t1) / 2));
  }
  void add_peer_delay(std::int64_t t1, std::int64_t t2, std::int64_t t3, std::int64_t t4) {
    delay_ = median_.add(Nanoseconds((t4 - t1) / 2 - (t3 - t2) / 2));
  }
  // The clock has been stepped: the last Sync counts no more.
  void forget_sync() { sync_.reset(); }

  const std::optional<Sync>& sync() const { return sync_; }
  // Nothing before both a Sync and a delay.
  std::optional<Nanoseconds> offset() const {
    if (!sync_ || !delay_) return std::nullopt;
    return Nanoseconds(sync_->t2 - sync_->t1) - *delay_;
  }

 private:
  MovingMedian median_;
  std::optional<Sync> sync_;
  std::optional<Nanoseconds> delay_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_PTP_PTP_OFFSET_H_
