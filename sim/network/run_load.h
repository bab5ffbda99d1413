// How loaded the hosts and the network are during one run: the draws that differ from pipeline to
// pipeline.
//
// In the calibrated worlds every cell of the published tables was a run of its own, with a load of
// its own: one factor M for the run, an extra occupancy of the sender and an extra latency for each
// session (a session is a pair of hosts: they share the latency, each end has an occupancy of its
// own, so that naive two-way stamps are asymmetric by their difference), a factor on each host's
// set calls. All are drawn per (run seed, load key); nothing else in the world depends on the load
// key, so pipelines stay paired by seed in everything else. Draws are keyed, not stored.
//
// Source: docs/reference/calibration.md sections 1 and 2 (rmult, callrun, Lrun, Srun);
// docs/design.md section 6.
//
//   const RunLoad load(seed, "both@18cam_6host_45fps", scenario.hosts, scenario.network);
//   double occupancy_ms = load.session(0, 3).send_cost_ms;
#ifndef SIMBENCH_SIM_NETWORK_RUN_LOAD_H_
#define SIMBENCH_SIM_NETWORK_RUN_LOAD_H_

#include <cstdint>
#include <string_view>

#include "algorithms/ports/exchange.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

// What the load adds to every message of a session.
struct SessionLoad {
  double send_cost_ms = 0;
  double latency_ms = 0;
};

class RunLoad {
 public:
  RunLoad(std::uint64_t run_seed, std::string_view load_key, const scenarios::Hosts& hosts,
          const scenarios::Network& network);

  // M of the run.
  double factor() const { return factor_; }
  // Of messages that `from` sends to `to`.
  SessionLoad session(PeerId from, PeerId to) const;
  // Factor on the cost of this host's set calls.
  double set_cost_factor(PeerId host) const;

 private:
  std::uint64_t run_seed_;
  ComponentKey session_key_;
  ComponentKey set_cost_key_;
  double factor_;
  double send_cost_mean_ms_;
  double latency_mean_ms_;
  double set_cost_log_sigma_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_NETWORK_RUN_LOAD_H_
