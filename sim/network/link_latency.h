// The latency of one direction of a link, without the queues of messages at the switches' ports.
//
//   law (fixed, Exp and spikes, or a table: laws/message_law.h) +- asymmetry / 2
//   + burst (while one lasts) + session
//   + for each switch on the way: residence + wait for foreign traffic, for each but the first: Exp
//
// The asymmetry is the fixed latency from the host of lower number to that of higher number minus
// the fixed latency back: one draw per link, and that of the lower host's port less that of the
// higher host's, one draw per host. A latency is never negative.
//
// The wait for foreign traffic is that of an M/D/1 queue, whose ports are busy for a share r with
// frames that take S each (Pollaczek and Khinchine): a sum of N draws from U(0, S), where N is
// geometric, P(N >= n) = r^n.
//
// What the scenario states of a slave's link with the master (network/links) takes the place of
// fixed, of the mean of Exp and of the link's draw.
//
// Source: docs/reference/calibration.md section 2 ("lat()"); docs/reference/host_sync.md section 3;
// ITU-T G.8261 appendix VI (load); Kleinrock, "Queueing Systems" vol. 1, section 5.7.
#pragma once

#include <cstdint>

#include "algorithms/ports/exchange.h"
#include "laws/message_law.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/engine/random.h"
#include "sim/network/load.h"

namespace simbench::sim {

// The key of the bursts on links.
inline constexpr ComponentKey kLinkBursts("network: bursts");

class LinkLatency {
 public:
  // `session_latency_ms` is added. `network` must outlive this. Linear in the links it states.
  LinkLatency(const scenarios::Network& network, std::uint64_t run_seed, PeerId from, PeerId to,
              double session_latency_ms);

  // What no switch can know: the fixed latency (the table's least) and the asymmetry.
  Nanoseconds cable() const { return cable_; }

  // The latency of a message that leaves at `left`; `draw` is the message's own stream.
  Nanoseconds draw(RandomStream& draw, TrueTime left);

 private:
  // In all switches on the way.
  double draw_residence_ms(RandomStream& draw) const;

  const scenarios::Network* network_;
  LatencyLaw law_;
  Nanoseconds cable_{};
  BurstProcess bursts_;
  int switches_ = 1;             // on the way
  double foreign_frame_ms_ = 0;  // 0: no foreign traffic
};

}  // namespace simbench::sim
