// The two ends of PTP (ptp.h), and what the slave computes from the stamps.
//
// Every stamp is a count of nanoseconds of the clock that stamps (stamps.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "algorithms/host_sync/outcome.h"
#include "algorithms/host_sync/ptp/ptp.h"
#include "algorithms/host_sync/ptp/ptp_clocks.h"
#include "algorithms/host_sync/ptp/ptp_message.h"
#include "algorithms/host_sync/ptp/ptp_servo.h"
#include "algorithms/ports/host.h"
#include "algorithms/ports/time.h"

namespace simbench {

// The master's port towards one slave.
class PtpMaster {
 public:
  // It sends Sync while *is_ready.
  PtpMaster(Host& host, PeerId slave, PtpSettings settings, std::shared_ptr<const bool> is_ready)
      : host_(host),
        slave_(slave),
        settings_(settings),
        stamps_(host, settings.stamps),
        is_ready_(std::move(is_ready)) {}

  // Never ends, unless the host lacks the stamps.
  Task<void> run();

 private:
  MessageChannel& channel() { return host_.open_channel(slave_, Transport::kDatagram); }
  Task<void> send_sync();
  Task<void> answer(ReceivedMessage received);

  Host& host_;
  PeerId slave_;
  PtpSettings settings_;
  MessageStamps stamps_;
  std::shared_ptr<const bool> is_ready_;
  std::uint16_t sequence_ = 0;
  std::optional<std::uint16_t> answered_;  // the last request for a peer delay
};

// The median of the last N values: linuxptp's delay filter (N = 10).
//
// For an even number it is the mean of the middle two, rounded towards zero.
// Complexity: O(N) a value. Source: docs/reference/host_sync.md section 1 (linuxptp).
//
//   MovingMedian median(10);
//   Nanoseconds delay = median.add(measured);
class MovingMedian {
 public:
  // `length` of at least 1.
  explicit MovingMedian(std::size_t length) : length_(length) {}

  Nanoseconds add(Nanoseconds value) {
    values_.push_back(value);
    if (values_.size() > length_) values_.pop_front();
    std::vector<Nanoseconds> sorted(values_.begin(), values_.end());
    std::sort(sorted.begin(), sorted.end());
    const std::size_t middle = sorted.size() / 2;
    if (sorted.size() % 2 == 1) return sorted[middle];
    return (sorted[middle - 1] + sorted[middle]) / 2;
  }
  void clear() { values_.clear(); }

 private:
  std::size_t length_;
  std::deque<Nanoseconds> values_;
};

// From PTP's stamps to the offset that a servo is fed.
//
// End to end: a Sync leaves the master at t1 and reaches the slave at t2, a Delay_Req leaves at t3
// and reaches the master at t4; delay = ((t2 - t3) r + (t4 - t1)) / 2 with the last Sync before it
// and the servo's rate ratio r.
// Peer delay: request t1 to t2, response t3 to t4; delay = ((t4 - t1) - (t3 - t2)) / 2.
// The delay is the median of the last 10; offset = t2 - t1 - delay, slave minus master.
//
// All stamps in nanoseconds, corrections of transparent clocks already taken out; the clocks' rates
// are taken as equal within a peer delay measurement.
// Source: IEEE 1588-2008 clause 11; docs/reference/host_sync.md section 1 (linuxptp, tsproc.c).
//
//   PtpOffset filter(10);
//   filter.add_sync(t1_ns, t2_ns);
//   filter.add_request(t3_ns, t4_ns, 1 + 5e-6);  // as the servo has found it
//   std::optional<Nanoseconds> offset = filter.offset();
class PtpOffset {
 public:
  struct Sync {
    std::int64_t t1 = 0;
    std::int64_t t2 = 0;
  };

  explicit PtpOffset(std::size_t median_length) : median_(median_length) {}

  void add_sync(std::int64_t t1, std::int64_t t2) { sync_ = Sync{t1, t2}; }
  // Ignored without a Sync.
  void add_request(std::int64_t t3, std::int64_t t4, double rate_ratio) {
    if (!sync_) return;
    const Nanoseconds apart(sync_->t2 - t3);
    const Nanoseconds gained = from_ns((rate_ratio - 1) * to_ns(apart));
    delay_ = median_.add((apart + gained) / 2 + Nanoseconds((t4 - sync_->t1) / 2));
  }
  void add_peer_delay(std::int64_t t1, std::int64_t t2, std::int64_t t3, std::int64_t t4) {
    delay_ = median_.add(Nanoseconds((t4 - t1) / 2 - (t3 - t2) / 2));
  }
  // Discards the last Sync, after a step of the clock.
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

// The slave's port.
class PtpSlave {
 public:
  PtpSlave(Host& host, PeerId master, PtpSettings settings);

  // Never ends, unless the host lacks the stamps.
  Task<void> run();
  // Whether the clock that stamps follows the master.
  std::shared_ptr<const bool> is_locked() const { return is_locked_; }

 private:
  // One message of a pair, while the other is to come.
  struct Half {
    PtpMessage message;
    std::int64_t stamp = 0;  // arrival, or departure of the own request
  };

  MessageChannel& channel() { return host_.open_channel(master_, Transport::kDatagram); }
  Task<void> ask();
  Task<void> take(ReceivedMessage received);
  // Whether a Sync is a copy of a used one, or was overtaken by another.
  bool is_late(std::uint16_t sequence) const;
  Task<void> take_sync();
  void take_delay_response(const PtpMessage& response);
  void take_peer_delay();
  Task<void> correct();
  void report(std::int64_t t1, std::int64_t t2, std::int64_t t3, std::int64_t t4);
  void report_outcome_if_due();

  Host& host_;
  PeerId master_;
  PtpSettings settings_;
  std::unique_ptr<Servo> servo_;
  std::optional<ClockCoupling> coupling_;  // with hardware stamps
  MessageStamps stamps_;
  PtpOffset offset_;
  std::uint16_t sequence_ = 0;
  std::optional<Half> request_;
  std::optional<std::uint16_t> last_sync_;  // the last one used
  std::optional<Half> sync_;
  std::optional<PtpMessage> sync_follow_up_;
  std::optional<Half> peer_response_;
  std::optional<PtpMessage> peer_follow_up_;
  std::shared_ptr<bool> is_locked_ = std::make_shared<bool>(false);
  std::uint32_t corrections_ = 0;
  SteadyTime begin_{};
  OutcomeReport outcome_;
};

}  // namespace simbench
