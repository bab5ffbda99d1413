// The load of the hosts and the network, during one run and from one moment to the next.
//
//  - RunLoad: the load of one run, which depends on its pipeline.
//  - BurstProcess: foreign traffic or other programs that come and go.
//  - HostLoad: the effect of such bursts on one host.
//
// Source: docs/reference/calibration.md sections 1 and 2 (rmult, callrun, Lrun, Srun);
// docs/design.md section 6; scenario /hosts/load_burst and /network/burst.
//
//   const RunLoad load(seed, "both@18cam_6host_45fps", scenario.hosts, scenario.network);
//   const double occupancy_ms = load.session(0, 3).send_cost_ms;
//
//   BurstProcess bursts({.rate_hz = 0.5, .duration_exponential_ms = 20, .latency_ms = 3}, seed,
//                       kLinkBursts, 7);
//   const double extra_ms = bursts.active(engine.now()) ? 3 : 0;
//
//   HostLoad host(scenario.hosts.load_burst, seed, 3);
//   const TrueTime noticed = arrival + host.delay(arrival, kMessage, direction, id);
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "algorithms/ports/exchange.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

// Added to every message of a session.
struct SessionLoad {
  double send_cost_ms = 0;  // more for each send
  double latency_ms = 0;    // more on the way of each message
};

// The draws that differ from pipeline to pipeline.
//
// In the calibrated worlds every cell of the published tables was a run with a load of its own: one
// factor M for the run, an extra occupancy of the sender and an extra latency for each session (a
// session is a pair of hosts: they share the latency, but each end has its own occupancy, so that
// naive two-way stamps are asymmetric by the difference), a factor on each host's set calls. All
// are drawn per (run seed, load key); nothing else in the world depends on the load key, so
// pipelines stay paired by seed in everything else. Draws are keyed, not stored.
class RunLoad {
 public:
  RunLoad(std::uint64_t run_seed, std::string_view load_key, const scenarios::Hosts& hosts,
          const scenarios::Network& network);

  // M of the run.
  double factor() const { return factor_; }
  // For messages from `from` to `to`.
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

// Bursts of foreign traffic on one direction of a link, or of load on a host.
//
// Bursts begin as a Poisson process in true time and last an exponential time each; they may
// overlap. The process is independent of the messages: it is sampled on a fixed grid of true time
// whose cells have random numbers of their own, so queries at any instants in any order agree. A
// cell is 20 mean durations long and a burst is cut off at the length of a cell (once in 5e8
// bursts), so only two cells matter at any instant. Where more than 50 bursts are under way on
// average, one always is (but once in 5e21 instants) and nothing is sampled.
//
// Complexity: O(1), cheap while the queries stay in one cell.
class BurstProcess {
 public:
  // `kind` and `number` tell the processes of a run apart.
  BurstProcess(const scenarios::Burst& parameters, std::uint64_t run_seed, ComponentKey kind,
               std::uint64_t number);

  bool active(TrueTime t) { return (is_always_active_ || cell_ns_ != 0) && sampled(t); }

 private:
  struct Interval {
    TrueTime begin;
    TrueTime end;
  };

  bool sampled(TrueTime t);
  void sample_cell(std::int64_t cell);

  std::uint64_t run_seed_;
  ComponentKey kind_;
  std::uint64_t number_;
  double mean_gap_ms_;  // between beginnings
  double mean_duration_ms_;
  double cell_ms_ = 0;
  bool is_always_active_ = false;
  std::int64_t cell_ns_ = 0;  // 0: no bursts, or always one
  std::int64_t cell_ = 0;     // the bursts below are those that can be active in this cell
  bool is_sampled_ = false;
  std::vector<Interval> bursts_;
};

// Bursts of load on one host: a burst delays the delivery of each frame and the receipt of each
// message by U(0, 2 * latency_ms). It does not delay clock calls, sends and interrupts.
class HostLoad {
 public:
  HostLoad(const scenarios::Burst& parameters, std::uint64_t run_seed, PeerId host);

  // The delay of what arrives at `at` with the key (what, a, b).
  Nanoseconds delay(TrueTime at, ComponentKey what, std::uint64_t a, std::uint64_t b) {
    return bursts_.active(at) ? drawn(what, a, b) : Nanoseconds(0);
  }

 private:
  Nanoseconds drawn(ComponentKey what, std::uint64_t a, std::uint64_t b) const;

  std::uint64_t run_seed_;
  double latency_ms_;
  BurstProcess bursts_;
};

}  // namespace simbench::sim
