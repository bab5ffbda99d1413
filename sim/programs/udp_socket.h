// A socket of datagrams, as the kernel of a simulated host keeps it: what has come for it, what it
// is told of what it sent, and its options. UDP's, or a packet socket, whose datagrams are frames
// (sim/programs/host_frames.h).
//
// The error queue holds what has left, with its stamp, and what was refused. `error` is what the
// next call fails with, once (SO_ERROR): a refusal sets it for a socket that is connected or
// receives errors.
//
// Source: socket(7), ip(7), udp(7), packet(7); Linux, net/core/sock.c, datagram.c and skbuff.c.
//
//   UdpSocket socket{.family = AF_INET};
//   queue_arrival(socket, {.arrival = {.length = 5}, .payload = Bytes(5)});
//   const int events = readiness_of(socket);  // POLLIN | POLLOUT
//   TakenDatagram taken = take_datagram(socket, shim::kLeaveIt);
#pragma once

#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "algorithms/ports/host.h"
#include "shim/protocol.h"
#include "sim/programs/packet_filter.h"

namespace simbench::sim {

struct QueuedDatagram {
  shim::Arrival arrival{};
  Bytes payload{};
};

// Options that IPv4 and IPv6 have one each of.
struct IpOptions {
  std::uint8_t hops = 64;
  std::uint8_t group_hops = 1;
  std::uint8_t traffic_class = 0;
  int mtu_discovery = 1;              // IP_PMTUDISC_WANT
  bool never_fragments = false;       // IPV6_DONTFRAG
  bool receives_errors = false;       // IP_RECVERR
  bool takes_all_groups = true;       // IP_MULTICAST_ALL
  bool hears_itself = true;           // IP_MULTICAST_LOOP
  std::uint32_t group_interface = 0;  // IP_MULTICAST_IF
};

// What a packet socket has beside.
struct PacketPart {
  struct Membership {
    int kind = 0;  // PACKET_MR_...
    std::uint32_t interface = 0;
    shim::PacketAddress group{};
  };

  bool has_link_heads = true;     // SOCK_RAW
  std::uint16_t protocol = 0;     // an Ethertype; 0: nothing comes
  std::uint32_t interface = 0;    // 0: any
  bool ignores_outgoing = false;  // PACKET_IGNORE_OUTGOING
  shim::ArrivalCount counted{};   // PACKET_STATISTICS
  std::vector<Membership> memberships{};
};

struct UdpSocket {
  static constexpr std::size_t kMostQueued = 256;
  static constexpr std::size_t kMostQueuedBytes = 212'992;  // as Linux' default for either end

  int family = AF_INET;
  shim::Address local{};  // port 0: not bound
  std::optional<shim::Address> peer{};
  bool states_host = false;  // the program has bound it to its address, and to its port
  bool states_port = false;
  bool only_ipv6 = false;         // IPV6_V6ONLY
  std::uint32_t interface = 0;    // SO_BINDTODEVICE; 0: any
  unsigned arrival_stamps = 0;    // shim::StampKind, as bits
  unsigned departure_stamps = 0;  // likewise
  bool shares_port = false;       // SO_REUSEADDR
  bool may_broadcast = false;
  bool has_urgent_errors = false;  // SO_SELECT_ERR_QUEUE
  IpOptions ipv4{};
  IpOptions ipv6{};
  std::vector<shim::Address> groups{};  // the scope of each is its interface
  PacketFilter filter{};                // SO_ATTACH_FILTER
  std::optional<PacketPart> packet{};
  int error = 0;
  int is_shut = 0;                       // 1: reading, 2: writing, as bits
  std::uint32_t sent = 0;                // the number of the next datagram with a stamp
  std::deque<QueuedDatagram> arrived{};  // not received by the program yet
  std::size_t arrived_bytes = 0;
  std::deque<QueuedDatagram> error_queue{};
  std::function<void()> on_arrival = [] {};
  std::uint64_t number = 0;  // since it was bound

  IpOptions& options(bool is_ipv4) { return is_ipv4 ? ipv4 : ipv6; }
  const IpOptions& options(bool is_ipv4) const { return is_ipv4 ? ipv4 : ipv6; }
};

// What came for it, unless its filter or its buffer has no place for it.
void queue_arrival(UdpSocket& socket, QueuedDatagram datagram);
// What it is told of something that it sent.
void queue_error(UdpSocket& socket, QueuedDatagram datagram);

// As of poll().
int readiness_of(const UdpSocket& socket);

struct TakenDatagram {
  int error = 0;  // EAGAIN, ESHUTDOWN at the end, or what was pending
  QueuedDatagram datagram{};
};
TakenDatagram take_datagram(UdpSocket& socket, std::int64_t how);  // shim::ReceiveFlag as bits
// SO_ERROR.
int take_error(UdpSocket& socket);

// As shim::Call::kSetOption; an errno, or 0.
int set_socket_option(UdpSocket& socket, std::int64_t option, std::int64_t value);

}  // namespace simbench::sim
