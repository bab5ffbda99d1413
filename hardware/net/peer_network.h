// A node's sockets: streams and datagrams to its peers, and streams from conductors.
//
// One TCP listener and one UDP socket on the same port. Between two hosts there is one
// SecureStream, which the host of higher number opens, and reopens when it is lost. Datagrams of
// the pair are sealed under a key of that stream's session, with a counter that is accepted once (a
// window of 1024, as in RFC 6479), and say in the seal which of the pair's two datagram channels
// they are for. A host's MessageChannels (one for each Transport) are views of these and survive a
// reconnection; messages sent meanwhile are lost, as over any network.
//
// Contract
//  - Bounded everywhere: 64 unauthenticated connections of 2 s, 1024 received messages a
//    channel (the oldest is dropped), 64 KiB a peer message, and a rate limit for datagrams from
//    outside a session.
//  - Receive stamps come from the kernel where it stamps; the channel turns them into host and
//    steady time by the node's clock. MessageChannel::transmit_stamp likewise.
//  - A second connection of a host replaces the first only after it has proved the key.
//  - Connections of conductors go to on_conductor after their handshake.
//  - `statistics()` counts refusals by reason.
//  - One thread; the io_context must not run after this has gone.
//
//   PeerNetwork network(context, settings, clock);
//   network.on_conductor([&](std::unique_ptr<SecureStream> stream) { ... });
//   network.start();
//   MessageChannel& channel = network.channel(2, Transport::kDatagram);
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/ports/host.h"
#include "hardware/clock/node_clock.h"
#include "hardware/net/secret_key.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {

struct PeerAddress {
  std::string address;  // numeric IPv4 or IPv6, or a name
  std::uint16_t port = 0;
};

struct PeerNetworkSettings {
  PeerId me = 0;
  PeerAddress listen;              // port 0: any free one, see port()
  std::vector<PeerAddress> peers;  // by host; this host's own is not used
  SecretKey key;
};

struct NetworkStatistics {
  std::uint64_t datagrams_received = 0;
  std::uint64_t refused_forged = 0;     // seal broken, or no session
  std::uint64_t refused_replayed = 0;   // counter seen before, or too old
  std::uint64_t refused_malformed = 0;  // truncated, oversized, unknown channel
  std::uint64_t refused_rate = 0;       // beyond the bucket
  std::uint64_t refused_connections = 0;
  std::uint64_t dropped_full_queue = 0;
  std::uint64_t reconnections = 0;  // of streams that were lost
};

class PeerNetwork {
 public:
  // Throws StreamError if the address cannot be bound. `clock` outlives this.
  PeerNetwork(boost::asio::io_context& context, PeerNetworkSettings settings, NodeClock& clock);
  ~PeerNetwork();
  PeerNetwork(const PeerNetwork&) = delete;
  PeerNetwork& operator=(const PeerNetwork&) = delete;

  void on_conductor(std::function<void(std::unique_ptr<SecureStream>)> handler);
  void start();
  std::uint16_t port() const;

  // The same object each time; lives as long as this. kStream keeps message bounds.
  MessageChannel& channel(PeerId peer, Transport transport);
  // Discards messages that wait in channels, so that a session begins without the last one's.
  void clear();
  bool connected(PeerId peer) const;
  const NetworkStatistics& statistics() const;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace simbench::hardware
