// What a station of generalised PTP computes: the delay and the rate of its neighbour, and the
// grandmaster's time on a clock of its own that nobody steers.
//
// Stamps are whole nanoseconds of the clock that stamps, a rate ratio is the rate of another clock
// against the own one.
// Source: IEEE 802.1AS-2020, 10.2 and 11.2 (peer delay, neighborRateRatio, cumulativeScaledRate-
// Offset).
//
//   LinkDelay link(8);
//   link.add({.t1 = 0, .t2 = 400, .t3 = 1400, .t4 = 1800});
//   const auto delay = link.delay();  // 400 ns
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "algorithms/ports/time.h"

namespace simbench {

// Peer delay: the request leaves here at t1 and is there at t2, the response leaves there at t3 and
// is here at t4.
struct PeerDelayExchange {
  std::int64_t t1 = 0;
  std::int64_t t2 = 0;
  std::int64_t t3 = 0;
  std::int64_t t4 = 0;
};

// The delay of the link, the mean over the last exchanges, and the neighbour's rate ratio r, by the
// departures and arrivals of the first and the last of their responses:
//   r = (t3' - t3) / (t4' - t4),   delay = (r (t4 - t1) - (t3 - t2)) / 2.
// Cost: O(exchanges) each.
class LinkDelay {
 public:
  // `exchanges` of at least 2.
  explicit LinkDelay(std::size_t exchanges) : most_(exchanges) {}

  void add(const PeerDelayExchange& exchange);
  // Nothing before two exchanges.
  std::optional<double> rate_ratio() const;
  // In nanoseconds of the neighbour; nothing before an exchange.
  std::optional<double> delay() const;

 private:
  std::size_t most_;
  std::deque<PeerDelayExchange> exchanges_;
};

// The grandmaster's time over the own clock, by one Sync.
struct GrandmasterTime {
  std::int64_t origin_ns = 0;  // preciseOriginTimestamp
  std::int64_t local_ns = 0;   // when the Sync arrived, on the own clock
  double after_origin_ns = 0;  // how much later than its origin that was, in the grandmaster's time
  double rate = 1;             // the grandmaster's against the own clock

  // How much later than the origin it is when the own clock reads that.
  double after_origin_at(std::int64_t own_ns) const {
    return after_origin_ns + rate * static_cast<double>(own_ns - local_ns);
  }
  // The grandmaster's time minus what the own clock reads.
  double ahead_ns(std::int64_t own_ns) const {
    return static_cast<double>(origin_ns - own_ns) + after_origin_at(own_ns);
  }
};

// Follow_Up's cumulativeScaledRateOffset, (rate - 1) in steps of 2^-41, and back.
std::int32_t scaled_rate_offset(double rate);
double rate_of_scaled(std::int32_t offset);

}  // namespace simbench
