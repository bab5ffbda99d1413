// Makes two-way exchanges between two clocks that are known exactly.
#pragma once

#include "algorithms/host_sync/two_way/two_way_estimators.h"

namespace simbench {

// The remote clock: reads `offset` at steady zero and gains `rate_ppb`.
inline ClockLine remote_clock(Nanoseconds offset, double rate_ppb) {
  return {.at = SteadyTime{}, .value = HostTime(offset), .rate_ppb = rate_ppb};
}

// A request that leaves at `sent` and takes `out`, a stay at the peer, a reply that takes `back`.
inline TwoWayExchange exchange_at(const ClockLine& remote, SteadyTime sent, Nanoseconds out,
                                  Nanoseconds back, Nanoseconds stay = from_ms(0.05)) {
  return {.sent = sent,
          .arrived = remote.read(sent + out),
          .replied = remote.read(sent + out + stay),
          .received = sent + out + stay + back};
}

inline SteadyTime at_second(double seconds) { return SteadyTime(from_ms(seconds * 1e3)); }

}  // namespace simbench
