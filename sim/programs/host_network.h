// UDP on the simulated network, as the programs of one host have it.
//
// Host i has the address 10.0.0.1 + i in 10.0.0.0/16; a network has at most 65000 hosts. A datagram
// goes over the port's channel to its host (algorithms/ports/host.h), one to a group or to all as
// one message (sim/host/sim_channel.h), with its destination and its ports behind the payload:
// eight bytes on the wire beside the headers that the network counts anyway.
//
//  - Unicast: to the socket that is bound to the port, unless that is connected to another; of
//    several that share the port, to the one that states most of the addresses, and of equals to
//    the one bound last. Datagrams to the host itself arrive at once.
//  - Multicast, 224.0.0.0/4: to each socket that is bound to the port on the members' hosts and has
//    joined the group, or takes what any socket of its host has joined (IP_MULTICAST_ALL). Any
//    time to live reaches all of the network.
//  - Broadcast, 255.255.255.255 and 10.0.255.255: to each socket that is bound to the port, on all
//    other hosts. Needs SO_BROADCAST.
// What nobody waits for is dropped, and so is what comes when a socket holds kMostQueued.
//
// pump(peer) is the receiving half, a coroutine for each peer: wake-ups cost what the scenario says
// and stamps are taken where it says, as for any algorithm. stamp_departures() puts hardware stamps
// into error queues as messages pass the card.
//
// Source: ip(7), udp(7), socket(7); Linux' Documentation/networking/timestamping.
//
//   HostNetwork network(host, 6);
//   UdpSocket own;
//   network.bind(own, {.host = 0, .port = 123});
//   const int error = co_await network.send(own, {.host = processes::address_of(0), .port = 123},
//                                           Bytes(48), own.departure_stamps);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "algorithms/ports/host.h"
#include "processes/placeholders.h"
#include "shim/protocol.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"
#include "sim/programs/host_streams.h"

namespace simbench::sim {

struct QueuedDatagram {
  shim::Arrival arrival;
  Bytes payload;
};

// What the card stamps.
struct CardStamping {
  bool arrivals = false;
  bool departures = false;
};

struct UdpSocket {
  shim::Address local{};  // port 0: not bound
  std::optional<shim::Address> peer{};
  unsigned arrival_stamps = 0;    // shim::StampKind, as bits
  unsigned departure_stamps = 0;  // likewise
  bool shares_port = false;       // SO_REUSEADDR
  bool may_broadcast = false;
  bool has_urgent_errors = false;  // SO_SELECT_ERR_QUEUE
  bool takes_all_groups = true;    // IP_MULTICAST_ALL
  bool hears_itself = true;        // IP_MULTICAST_LOOP
  std::set<std::uint32_t> groups{};
  std::uint32_t sent = 0;                 // the number of the next datagram
  std::deque<QueuedDatagram> arrived{};   // not received by the program yet
  std::deque<QueuedDatagram> departed{};  // the error queue: what has left, with its stamp
  std::function<void()> on_arrival{};
  std::uint64_t number = 0;  // since it was bound
};

class HostNetwork {
 public:
  static constexpr std::size_t kMostQueued = 256;
  static constexpr std::size_t kMostGroups = 20;     // of a socket
  static constexpr std::size_t kMostPayload = 1472;  // one frame; fragments are not simulated

  // The host must outlive this.
  HostNetwork(SimHost& host, std::size_t hosts);

  std::size_t hosts() const { return hosts_; }
  std::uint32_t address() const { return processes::address_of(host_.id()); }

  // These return an errno, or 0. A bound socket must be closed before it ends.
  int bind(UdpSocket& socket, shim::Address address);
  int connect(UdpSocket& socket, shim::Address peer);
  int join(UdpSocket& socket, std::uint32_t group);
  int leave(UdpSocket& socket, std::uint32_t group);
  // `stamps` are those of this departure: shim::StampKind as bits.
  Task<int> send(UdpSocket& socket, shim::Address to, Bytes payload, unsigned stamps);
  void close(UdpSocket& socket);

  // What the card stamps (SIOCSHWTSTAMP), for all sockets of the host; nothing at first.
  CardStamping card_stamping() const { return card_stamping_; }
  void set_card_stamping(CardStamping stamping) { card_stamping_ = stamping; }

  HostStreams& streams() { return streams_; }

  // Receives from a peer, for ever.
  Task<void> pump(PeerId peer);
  // Stamps what leaves, for ever.
  Task<void> stamp_departures();

 private:
  // A message on its way to the card.
  struct Leaving {
    std::uint64_t socket = 0;
    std::optional<PeerId> peer{};  // nothing: a group
    unsigned stamps = 0;           // shim::StampKind as bits
    MessageId message = 0;
    QueuedDatagram datagram{};
  };

  bool is_taken(shim::Address address, const UdpSocket& by) const;
  // To a free port if the address has none.
  int bind_to(UdpSocket& socket, shim::Address address);
  // The group that a message to this address is for, if it is for several hosts.
  static std::optional<std::uint32_t> group_of(std::uint32_t address);
  Task<void> send_to_peer(UdpSocket& socket, Leaving leaving);
  Task<void> send_to_group(UdpSocket& socket, std::uint32_t group, Leaving leaving);
  // The message has left, with this stamp by software.
  void keep_stamps(UdpSocket& socket, std::optional<HostTime> left, Leaving leaving);
  static void queue_departure(UdpSocket& socket, QueuedDatagram datagram);
  void deliver(const QueuedDatagram& datagram);
  void deliver_to_all(const QueuedDatagram& datagram);
  static void queue_arrival(UdpSocket& socket, QueuedDatagram datagram);

  SimHost& host_;
  std::size_t hosts_;
  std::vector<UdpSocket*> bound_;
  std::uint64_t sockets_bound_ = 0;
  std::map<std::uint32_t, int> joined_;  // how many sockets, by group
  FreePorts ports_;
  CardStamping card_stamping_{};
  std::deque<Leaving> leaving_;
  WaitPoint has_left_;
  HostStreams streams_;
};

}  // namespace simbench::sim
