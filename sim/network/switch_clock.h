// The corrections that a switch with PTP adds to the event messages it forwards.
//
// A transparent switch adds the message's residence time to its correctionField: all from the last
// bit's way in to its arrival (the queues at the ports, the residence in each switch, the random
// latency, spikes, bursts, a session's load and detours) except the cable's part, the fixed latency
// and the asymmetry of the direction. The error is N(switch_clock_error_ns) per message.
//
// A boundary switch has a clock of its own, which a servo locks to the master (host 0), and answers
// its slaves itself. It is modelled as a transparent one whose slaves see the master through that
// clock: messages from the master are corrected by E(t) more, those to the master by E(t) less, so
// every slave behind it ends up E(t) ahead of the master and none differs from another. Where the
// way has more switches, each follows the one before and their errors add up (the servos' gain
// peaking along a chain is not modelled).
//
// The servo (BoundaryClock): once a second the switch measures its error x with noise
// N(switch_clock_error_ns) and steers by the proportional-integral servo of linuxptp for hardware
// stamps, k_p = 0.7, k_i = 0.3; its oscillator's frequency walks. It has run for an hour at true
// zero.
//
// Event messages are recognised by their layout (IEEE 1588-2019, clause 13.3): in a datagram, the
// low nibble of byte 0 (messageType) is at most 3, that of byte 1 (versionPTP) is 2, and bytes 2
// and 3 (messageLength) state 44 bytes or more and the datagram's length but for at most 80 bytes
// that follow the message (padding, and what a program's packet says of itself:
// sim/programs/packet.h); bytes 8 to 15 are the correctionField, big-endian, in units of 2^-16 ns.
//
// Source: IEEE 1588-2019; linuxptp's default configuration (pi_proportional_const and
// pi_integral_const: 0.7 and 0.3 at an interval of 1 s).
//
//   if (clock.corrects(bytes)) clock.correct(bytes, {from, to, id, copy}, residence, now);
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/ports/host.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/clock/grid_walk.h"

namespace simbench::sim {

// The clock of boundary switch `number`, against the one that it follows.
class BoundaryClock {
 public:
  BoundaryClock(const scenarios::Network& network, std::uint64_t run_seed, std::uint64_t number);

  double error_ns(TrueTime at) const;

 private:
  struct Servo {
    double error_ns = 0;
    double integral_ppb = 0;
    double frequency_ppb = 0;
  };

  // Moves the servo over a second; returns the growth of its error.
  double step(Servo& servo, std::int64_t second) const;

  std::uint64_t run_seed_;
  std::uint64_t number_;
  double noise_ns_;
  double wander_ppb_;
  GridWalk<Servo> walk_;
};

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

  // E(t) of the boundary switches between the master and `host`, whose own switch is one of them.
  double boundary_error_ns(PeerId host, TrueTime at) const;

 private:
  std::int64_t switch_of(PeerId host) const {
    return switch_of_host_.empty() ? 0 : switch_of_host_[host];
  }

  std::uint64_t run_seed_;
  scenarios::SwitchClockKind kind_;
  double error_sigma_ns_;
  std::vector<std::int64_t> switch_of_host_;
  std::vector<BoundaryClock> boundary_clocks_;  // by number of the switch
};

}  // namespace simbench::sim
