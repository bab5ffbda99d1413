// Bursts of load on one host: while one lasts, frames are delivered and messages noticed later.
//
// Bursts are a process in true time, each host's its own (sim/network/burst_process.h), so they do
// not depend on what arrives. What arrives during a burst is delayed by U(0, 2 * latency_ms), drawn
// for itself. Clock calls, sends and interrupts are not delayed.
//
// Source: scenario /hosts/load_burst.
//
//   HostLoad load(scenario.hosts.load_burst, seed, 3);
//   const TrueTime noticed = arrival + load.delay(arrival, kMessage, direction, id);
#ifndef SIMBENCH_SIM_HOST_HOST_LOAD_H_
#define SIMBENCH_SIM_HOST_HOST_LOAD_H_

#include <cstdint>

#include "algorithms/ports/exchange.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"
#include "sim/network/burst_process.h"

namespace simbench::sim {

class HostLoad {
 public:
  HostLoad(const scenarios::Burst& parameters, std::uint64_t run_seed, PeerId host);

  // Of what arrives at `at` and is known as (what, a, b).
  Nanoseconds delay(TrueTime at, ComponentKey what, std::uint64_t a, std::uint64_t b);

 private:
  std::uint64_t run_seed_;
  double latency_ms_;
  BurstProcess bursts_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_HOST_HOST_LOAD_H_
