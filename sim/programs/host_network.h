// UDP on the simulated network, as the programs of one host have it, by IPv4 and IPv6.
//
// A datagram goes over the host's channel to its receiver, one to a group or to all as one message,
// in fragments if it is large (sim/programs/packet.h has what each costs the wire). Where it goes
// and from which address is the routing table's matter (sim/programs/routes.h).
//
//  - Unicast: to the socket that is bound to the port, unless that is connected to another; of
//    several that share the port, to the one that states most of the addresses, and of equals to
//    the one bound last. Datagrams to the host itself arrive at once.
//  - Groups, 224.0.0.0/4 and ff00::/8: to each socket that is bound to the port on the members'
//    hosts and has joined the group, or takes what any socket of its host has joined
//    (IP_MULTICAST_ALL). All hosts are in 224.0.0.1 and ff02::1. Any number of hops but 0 reaches
//    all of the network.
//  - Broadcast, 255.255.255.255 and 10.0.255.255: to each socket that is bound to the port, on all
//    hosts. Needs SO_BROADCAST.
// What comes when a socket holds UdpSocket::kMostQueued is dropped. A datagram to one host for
// which there is no socket is answered by ICMP, which comes to its sender as any packet does; a
// host sends six such answers to another at once, and then one a second (IPv6: four). Within a host
// the answer comes at once.
//
// A socket of IPv6 takes IPv4 too unless it says IPV6_V6ONLY; addresses are mapped then.
//
// pump(peer) is the receiving half, a coroutine for each peer: wake-ups cost what the scenario says
// and stamps are taken where it says, as for any algorithm. run() stamps what leaves and answers,
// each at the cost of a send call.
//
// Not simulated: neighbour discovery and the reports of members, which take no time; distributing
// what comes among sockets (SO_REUSEPORT); corked sends (MSG_MORE); options of IP heads.
//
// Source: ip(7), ipv6(7), udp(7), socket(7); Linux' Documentation/networking/timestamping; Linux,
// net/ipv4/udp.c, icmp.c and their kin of IPv6.
//
//   HostNetwork network(host, 6);
//   UdpSocket own;
//   network.bind(own, shim::ipv4_address(0, 123));
//   const shim::Departure departure{.to = shim::ipv4_address(0x0A000001, 123)};
//   const int error = co_await network.send(own, departure, Bytes(48), own.departure_stamps);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "algorithms/ports/host.h"
#include "processes/placeholders.h"
#include "shim/protocol.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"
#include "sim/programs/host_frames.h"
#include "sim/programs/host_streams.h"
#include "sim/programs/packet.h"
#include "sim/programs/packet_sender.h"
#include "sim/programs/routes.h"
#include "sim/programs/udp_socket.h"

namespace simbench::sim {

class HostNetwork {
 public:
  static constexpr std::size_t kMostGroups = 20;  // of a socket

  // The host must outlive this.
  HostNetwork(SimHost& host, std::size_t hosts);

  std::size_t hosts() const { return hosts_; }
  std::uint32_t address() const { return routes_.ipv4(); }

  // These are of all sockets of datagrams, packet sockets among them, and return an errno, or 0.
  // `connect` to no family ends an association. A socket that was opened must be closed before it
  // ends.
  void open(UdpSocket& socket);
  int bind(UdpSocket& socket, shim::Address address);
  int connect(UdpSocket& socket, shim::Address peer);
  int shut_down(UdpSocket& socket, int how);
  // The scope of a group is its interface; `kind` is of packet sockets: PACKET_MR_...
  int join(UdpSocket& socket, bool joins, int kind, shim::Address group);
  // `stamps` are those of this departure: shim::StampKind as bits.
  Task<int> send(UdpSocket& socket, shim::Departure departure, Bytes payload, unsigned stamps);
  void close(UdpSocket& socket);

  const Cables& cables() const { return frames_.cables(); }
  CardStamping card_stamping() const { return sender_.card_stamping(); }
  void set_card_stamping(CardStamping stamping) { sender_.set_card_stamping(stamping); }

  HostStreams& streams() { return streams_; }

  // Receives from a peer, for ever.
  Task<void> pump(PeerId peer);
  // Stamps what leaves, and answers what nobody takes, for ever.
  Task<void> stamp_departures() { return sender_.stamp_departures(); }
  Task<void> answer_refused();

 private:
  // How many answers a peer may have: a bucket that fills with time.
  struct Allowance {
    double answers = 6;
    SteadyTime since{};
  };
  struct Membership {
    shim::Address group{};
    int sockets = 0;
  };

  bool is_taken(const shim::Address& address, const UdpSocket& by) const;
  // To a free port if the address has none.
  int bind_to(UdpSocket& socket, shim::Address address);
  void dissolve(UdpSocket& socket);
  Route route_of(const UdpSocket& socket, const shim::Departure& departure, bool is_connect) const;
  int check_size(UdpSocket& socket, const shim::Departure& departure, const Route& route,
                 std::size_t size) const;
  static WirePacket packet_for(const UdpSocket& socket, const shim::Departure& departure,
                               const Route& route, Bytes payload);
  bool stays_on_host(const PacketHead& head, bool loops) const;
  Task<void> transmit(UdpSocket& socket, const Route& route, WirePacket packet, unsigned stamps);

  int joined(const shim::Address& group) const;
  void count_member(const shim::Address& group, int change);
  int join_group(UdpSocket& socket, shim::Address group);
  int leave_group(UdpSocket& socket, const shim::Address& group);

  static QueuedDatagram arrived(const WirePacket& packet, std::uint32_t interface);
  UdpSocket* socket_for(const shim::Arrival& arrival) const;
  // A datagram to one host; false if nobody takes it.
  bool deliver(const QueuedDatagram& datagram);
  void deliver_to_all(const QueuedDatagram& datagram);
  void take(PeerId peer, WirePacket packet);
  // That a datagram of this host was refused.
  void take_refusal(const shim::Address& from, const shim::Address& to, Bytes quoted);
  bool may_answer(PeerId peer, bool is_ipv4);

  SimHost& host_;
  std::size_t hosts_;
  Routes routes_;
  PacketSender sender_;
  HostFrames frames_;
  std::vector<UdpSocket*> bound_;
  std::vector<Membership> members_;
  FreePorts ports_;
  std::uint32_t datagrams_ = 0;  // that were sent in fragments
  Reassembly reassembly_;
  std::map<std::pair<PeerId, bool>, Allowance> allowances_;
  std::deque<WirePacket> refusals_;  // to be sent
  WaitPoint has_refused_;
  HostStreams streams_;
};

}  // namespace simbench::sim
