// What a scenario's network does to each message: the law that the relay applies to real messages.
//
// The same law as the simulated network's (laws/message_law.h): a latency per direction of a link,
// half of the link's asymmetry with its sign, and
//
//  - datagrams: lost, doubled (the copy has a latency of its own), reordered (delayed by up to
//    reorder_max_ms); the others keep their order;
//  - streams: in order and complete; a lost message arrives a retransmission timeout later, doubled
//    each time, and delays all messages after it.
//
// All draws of a message are keyed by (seed, direction, kind, index of the message), so they do not
// depend on other messages. They are not the simulator's draws: the two are compared by their
// distributions.
//
// check_relay_can() refuses what a relay cannot imitate, as scenarios/schema.json says of each
// member ("x-relay"): bursts, bandwidth, Nagle's algorithm, capture traffic, switches that know PTP
// or stand in a line, wireless cells, latencies per session, stacks of hosts (the machine has one).
//
//   NetworkLaw law(scenario.network, seed, 0, 3);
//   for (MonotonicTime at : law.datagram(received)) send_at(at);
#pragma once

#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "algorithms/ports/exchange.h"
#include "hardware/clock/monotonic_time.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

// Throws scenarios::InputError, which names the member, what was found and what is allowed.
void check_relay_can(const scenarios::Scenario& scenario);

// Counts of the messages of one direction.
struct LawCounts {
  std::uint64_t datagrams = 0;
  std::uint64_t lost = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;
  std::uint64_t stream_messages = 0;
  std::uint64_t retransmissions = 0;

  LawCounts& operator+=(const LawCounts& other) {
    datagrams += other.datagrams;
    lost += other.lost;
    duplicated += other.duplicated;
    reordered += other.reordered;
    stream_messages += other.stream_messages;
    retransmissions += other.retransmissions;
    return *this;
  }
};

// One direction of a link.
class NetworkLaw {
 public:
  NetworkLaw(const scenarios::Network& network, std::uint64_t seed, PeerId from, PeerId to);

  // When a datagram that came at `received` arrives: never, once, or twice.
  using Arrivals = boost::container::static_vector<MonotonicTime, 2>;
  Arrivals datagram(MonotonicTime received);
  // When the next message of the stream arrives. A new connection goes on with the same count.
  MonotonicTime stream(MonotonicTime received);

  const LawCounts& counts() const { return counts_; }

 private:
  class Draws;
  Nanoseconds latency(Draws& draws) const;

  scenarios::Network network_;
  std::uint64_t key_;
  double half_asymmetry_ms_;
  MonotonicTime last_datagram_ = MonotonicTime::min();
  MonotonicTime last_stream_ = MonotonicTime::min();
  LawCounts counts_;
};

}  // namespace simbench::hardware
