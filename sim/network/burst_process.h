// Bursts of foreign traffic on one direction of a link, or of load on a host: when is it slow?
//
// Bursts begin as a Poisson process in true time and last an exponential time each; they may
// overlap. The process exists independently of the messages: it is sampled on a fixed grid of true
// time whose cells have random numbers of their own, so it can be asked at any instant, in any
// order, with the same answer. A cell is 20 mean durations long and a burst is cut off at the
// length of a cell (once in 5e8 bursts), so only two cells matter at any instant.
//
// Complexity: O(1), cheap while the instants asked for stay in one cell.
//
//   BurstProcess bursts({.rate_hz = 0.5, .duration_exponential_ms = 20, .latency_ms = 3}, seed,
//                       kLinkBursts, 7);
//   double extra_ms = bursts.active(engine.now()) ? 3 : 0;
#ifndef SIMBENCH_SIM_NETWORK_BURST_PROCESS_H_
#define SIMBENCH_SIM_NETWORK_BURST_PROCESS_H_

#include <cstdint>
#include <vector>

#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

class BurstProcess {
 public:
  // `kind` and `number` tell the processes of a run apart.
  BurstProcess(const scenarios::Burst& parameters, std::uint64_t run_seed, ComponentKey kind,
               std::uint64_t number);

  bool active(TrueTime t);

 private:
  struct Interval {
    TrueTime begin;
    TrueTime end;
  };

  void sample_cell(std::int64_t cell);

  std::uint64_t run_seed_;
  ComponentKey kind_;
  std::uint64_t number_;
  double mean_gap_ms_;  // between beginnings
  double mean_duration_ms_;
  double cell_ms_ = 0;
  std::int64_t cell_ns_ = 0;  // 0: no bursts
  std::int64_t cell_ = 0;     // the bursts below are those that can be active in this cell
  bool is_sampled_ = false;
  std::vector<Interval> bursts_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_NETWORK_BURST_PROCESS_H_
