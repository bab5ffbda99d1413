// The corrections that a switch with PTP adds to the event messages it forwards.
//
// A transparent switch adds the message's residence time to its correctionField: all from the last
// bit's way in to its arrival (the queue at its port, the random latency, spikes, bursts, a
// session's load and detours) except the cable's part, the fixed latency and the asymmetry of the
// direction. The error is N(switch_clock_error_ns) per message.
//
// A boundary switch is modelled as a transparent one whose slaves see the master through the
// switch's own servo: messages from the master (host 0) are corrected by E(t) more, those to the
// master by E(t) less, so every slave ends up E(t) ahead of the master and none differs from
// another. E(t) is a stationary normal process of standard deviation switch_clock_error_ns: a blend
// of independent values on a grid of 30 s, so constant over seconds and forgotten within a minute.
//
// Event messages are recognised by their layout (IEEE 1588-2019, clause 13.3): in a datagram, the
// low nibble of byte 0 (messageType) is at most 3, that of byte 1 (versionPTP) is 2, and there are
// 44 bytes or more; bytes 8 to 15 are the correctionField, big-endian, in units of 2^-16 ns.
//
//   if (clock.corrects(bytes)) clock.correct(bytes, {from, to, id, copy}, residence, now);
#ifndef SIMBENCH_SIM_NETWORK_SWITCH_CLOCK_H_
#define SIMBENCH_SIM_NETWORK_SWITCH_CLOCK_H_

#include <cstdint>

#include "algorithms/ports/host.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"

namespace simbench::sim {

class SwitchClock {
 public:
  // A message on its way; a duplicate is another copy.
  struct Passage {
    PeerId from = 0;
    PeerId to = 0;
    MessageId id = 0;
    std::uint32_t copy = 0;
  };

  SwitchClock(const scenarios::Network& network, std::uint64_t run_seed);

  bool corrects(const Bytes& message) const;
  // Adds the residence time to a message that it corrects and that arrives at `at`.
  void correct(Bytes& message, const Passage& passage, Nanoseconds residence, TrueTime at) const;

  // E(t) of a boundary switch.
  double boundary_error_ns(TrueTime at) const;

 private:
  std::uint64_t run_seed_;
  scenarios::SwitchClockKind kind_;
  double error_sigma_ns_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_NETWORK_SWITCH_CLOCK_H_
