// The slave's side of every algorithm that learns the master's clock from two-way exchanges: asks,
// estimates, steers, for ever. See two_way.h.
//
// refine() is where more than the network can be brought in: it is asked for the line to steer by
// each time, given the line that the exchanges say.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_SLAVE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_SLAVE_H_

#include <memory>

#include "algorithms/host_sync/two_way/two_way.h"
#include "algorithms/host_sync/two_way/two_way_probe.h"

namespace simbench {

class TwoWaySlave {
 public:
  TwoWaySlave(Host& host, PeerId master, TwoWaySettings settings,
              std::unique_ptr<TwoWayEstimator> estimator);
  virtual ~TwoWaySlave() = default;

  // Never ends.
  Task<void> run();

 protected:
  virtual Task<ClockLine> refine(ClockLine line);
  Host& host() { return host_; }
  MessageChannel& channel() { return host_.open_channel(master_, Transport::kDatagram); }

 private:
  // One exchange and what follows from it. Returns how long after it the next one is due.
  Task<Nanoseconds> turn();
  void report_outcome(bool is_steered);

  Host& host_;
  PeerId master_;
  TwoWaySettings settings_;
  std::shared_ptr<SteeredClock> clock_;
  TwoWayClient client_;
  std::unique_ptr<TwoWayEstimator> estimator_;
  SteadyTime steer_at_{};
  bool is_reported_ = false;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_SLAVE_H_
