// Estimators of a remote clock from two-way exchanges. They only compute: values in, values out.
//
// Of an exchange, sent and received are the own steady clock's, arrived and replied the remote
// system clock's. With remote(s) the remote reading at own steady time s and no negative delays
//
//   replied - received <= remote(received) - received     a lower bound of the difference
//   remote(sent) - sent <= arrived - sent                 an upper bound
//
// All of these assume equal minimum delays both ways; what the directions differ by, A, is in every
// result with A / 2, and nothing in the stamps can tell (docs/reference/host_sync.md section 3).
//
//   TwoWayHull hull({});
//   hull.add(exchange);
//   std::optional<ClockLine> line = hull.line();
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_ESTIMATOR_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_ESTIMATOR_H_

#include <optional>

#include "algorithms/host_sync/clock_line.h"

namespace simbench {

struct TwoWayExchange {
  SteadyTime sent{};      // t1
  HostTime arrived{};     // t2
  HostTime replied{};     // t3
  SteadyTime received{};  // t4

  // Without the time spent at the peer.
  Nanoseconds round_trip() const { return (received - sent) - (replied - arrived); }
};

class TwoWayEstimator {
 public:
  virtual ~TwoWayEstimator() = default;
  // Exchanges in order. Returns whether the line is a new one.
  virtual bool add(const TwoWayExchange& exchange) = 0;
  // Nothing before enough has come.
  virtual std::optional<ClockLine> line() = 0;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_ESTIMATOR_H_
