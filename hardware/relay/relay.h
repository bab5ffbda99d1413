// A relay: stands between each pair of nodes on one machine and is the network between them.
//
// For tests and the real-network experiment (hardware/experiment), not for rigs. The relay listens
// where the rig file of node i has host j, with TCP and UDP on one port, and forwards to node j
// after the delay of the scenario's network (network_law.h). It sends datagrams from its own socket
// for (j, i), to which node j answers. It forwards streams message by message (relayed_stream.h),
// with delays of its own for each direction.
//
//   node i --> [relay's address for j in i's file]  ... delay ...  --> node j's own address
//
// Delays count from the kernel's receive stamp, and a queue that wakes up early sends due messages
// (delay_queue.h), so that the relay's own scheduling adds nothing.
//
// Contract
//  - Addresses must be loopback, or private ones (RFC 1918) for namespaces made by a test: a relay
//    never listens to the world. It opens connections only to the nodes in its files.
//  - Bounded: kMaxDatagramsPerSecond in each direction (it drops and counts the rest), the queue's
//    limits, one stream a pair (a new one replaces the last).
//  - It survives any received bytes. One thread.
//
// Errors: RelayError from the constructor: an address that cannot be bound, is not allowed, or is
// missing.
//
//   Relay relay(context, {.nodes = rigs, .scenario = &scenario, .seed = 1});
//   context.run();   // until relay.stop()
//   std::string json = statistics_json(relay.statistics());
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hardware/relay/network_law.h"
#include "hardware/relay/relayed_stream.h"
#include "hardware/rig/rig.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

struct RelaySettings {
  // nodes[i] is the rig file of node i: its own entry is where it listens, the others are the
  // relay's addresses.
  std::vector<Rig> nodes;
  const scenarios::Scenario* scenario = nullptr;  // only the constructor reads it
  std::uint64_t seed = 1;
  // The interfaces of the programs' network (wires.h), in the order of the hosts; none without one.
  std::vector<std::string> wires{};
};

struct RelayStatistics {
  LawCounts law;                        // of all directions
  std::uint64_t dropped_full = 0;       // found no room in the queue
  std::uint64_t dropped_rate = 0;       // came too fast
  std::uint64_t streams = 0;            // connections relayed
  std::uint64_t broken_streams = 0;     // of those, ended because they were no SecureStream
  std::optional<Nanoseconds> late_p50;  // how late half of the messages left at most
  std::optional<Nanoseconds> late_p95;  // and 95 of 100
};

class Relay {
 public:
  static constexpr double kMaxDatagramsPerSecond = 20'000;

  Relay(boost::asio::io_context& context, const RelaySettings& settings);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  // Closes everything; the context then runs out of work.
  void stop();
  RelayStatistics statistics() const;

 private:
  class State;
  std::shared_ptr<State> state_;
};

// One line of JSON: the members of RelayStatistics, delays in microseconds.
std::string statistics_json(const RelayStatistics& statistics);

}  // namespace simbench::hardware
