// A virtual machine's processor that the hypervisor takes away now and then.
//
// Problem: a stolen slice is no delay of one message: all that falls into it waits for its end, and
// stamps of the kernel with it.
//
// Here it is a process in true time: in each cell of slice / share there is one slice, at any
// place of it, and each host's cells begin at a time of their own. At any instant the processor is
// away with probability share, and then for U(0, slice) more, so what comes waits for share * slice
// / 2 on average. Slices differ from host to host.
//
// Contract: what is asked changes nothing; the same seed gives the same slices. Cost: O(1).
// Source: scenario /hosts/steal; docs/reference/load.md.
//
//   StolenTime stolen(*scenario.hosts.steal, seed, 3);
//   const TrueTime runs_on = now + stolen.wait(now);
#pragma once

#include "algorithms/ports/exchange.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"

namespace simbench::sim {

class StolenTime {
 public:
  StolenTime(const scenarios::Steal& steal, std::uint64_t run_seed, PeerId host);

  // Until the processor is back, for what comes then.
  Nanoseconds wait(TrueTime at) const;

 private:
  double slice_ns_;
  double cell_ns_;   // 0: nothing is stolen
  double first_ns_;  // where a cell begins
  KeyedStreams draws_;
};

}  // namespace simbench::sim
