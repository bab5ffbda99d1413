// A hostile neighbour: sends a host's port what it must refuse, at a steady rate.
//
// Four kinds in turn: forged (a genuine datagram with one bit changed), replayed (genuine ones,
// taken from the wire, as they are), truncated, and oversized (60 kB of noise). They bear the
// address and port of the host's own peer, which needs raw sockets (root); loopback only.
#ifndef SIMBENCH_BENCH_HOSTILE_FLOOD_H_
#define SIMBENCH_BENCH_HOSTILE_FLOOD_H_

#include <sys/types.h>

#include <cstdint>

namespace simbench {

struct FloodPlan {
  std::uint16_t target_port = 0;
  std::uint16_t pretended_port = 0;
  int per_second = 10'000;
  int seconds = 15;
};

// Runs in a process of its own, which ends by itself. -1: raw sockets are not permitted here.
pid_t start_hostile_flood(const FloodPlan& plan);

}  // namespace simbench

#endif  // SIMBENCH_BENCH_HOSTILE_FLOOD_H_
