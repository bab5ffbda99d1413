#include "sim/programs/udp_socket.h"

#include <linux/errqueue.h>
#include <poll.h>

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cerrno>
#include <span>

#include "shim/addresses.h"
#include "sim/programs/packet.h"

namespace simbench::sim {
namespace {

constexpr int kShutForReading = 1;
constexpr int kShutForWriting = 2;

bool is_refusal(const QueuedDatagram& told) {
  return told.arrival.origin == SO_EE_ORIGIN_ICMP || told.arrival.origin == SO_EE_ORIGIN_ICMP6;
}

// The filter of a UDP socket sees UDP's head too, which passes with anything else.
bool passes_filter_of_udp(const UdpSocket& socket, QueuedDatagram& datagram) {
  const shim::Arrival& arrival = datagram.arrival;
  Bytes seen(kUdpHead);
  auto* head = reinterpret_cast<unsigned char*>(seen.data());
  boost::endian::store_big_u16(head, arrival.from.port);
  boost::endian::store_big_u16(head + 2, arrival.to.port);
  boost::endian::store_big_u16(head + 4,
                               static_cast<std::uint16_t>(kUdpHead + datagram.payload.size()));
  seen.insert(seen.end(), datagram.payload.begin(), datagram.payload.end());
  const bool is_ipv4 = shim::is_ipv4(arrival.to.host);
  const std::size_t passes =
      socket.filter.passed({.bytes = seen,
                            .protocol = static_cast<std::uint16_t>(is_ipv4 ? 0x0800 : 0x86DD),
                            .interface = arrival.interface});
  datagram.payload.resize(std::max(passes, kUdpHead) - kUdpHead);
  return passes > 0;
}

// A frame has its link's head here, which a socket of SOCK_DGRAM does not get.
bool passes_filter_of_frames(const UdpSocket& socket, QueuedDatagram& frame) {
  const std::size_t begin = socket.packet->has_link_heads ? 0 : kEthernetHead;
  const std::size_t passes =
      socket.filter.passed({.bytes = frame.payload,
                            .begin = begin,
                            .network_head = kEthernetHead,
                            .protocol = frame.arrival.from.port,
                            .kind = shim::unpacked(frame.arrival.from.host).kind,
                            .interface = frame.arrival.interface});
  const auto first = frame.payload.begin() + static_cast<std::ptrdiff_t>(begin);
  frame.payload = Bytes(first, first + static_cast<std::ptrdiff_t>(passes));
  return passes > 0;
}

// Names are of the family that the program has asked for.
void name_by_family(const UdpSocket& socket, shim::Arrival& arrival) {
  arrival.from.family = arrival.to.family = static_cast<std::uint16_t>(socket.family);
}

}  // namespace

void queue_arrival(UdpSocket& socket, QueuedDatagram datagram) {
  const bool passes = socket.packet            ? passes_filter_of_frames(socket, datagram)
                      : socket.filter.is_set() ? passes_filter_of_udp(socket, datagram)
                                               : true;
  if (!passes) return;
  if (socket.packet) ++socket.packet->counted.arrived;
  if (socket.arrived.size() == UdpSocket::kMostQueued ||
      socket.arrived_bytes >= UdpSocket::kMostQueuedBytes) {
    if (socket.packet) ++socket.packet->counted.dropped;
    return;
  }
  shim::Arrival& arrival = datagram.arrival;
  if ((socket.arrival_stamps & shim::kSoftwareStamps) == 0) arrival.system = shim::kNoStamp;
  if ((socket.arrival_stamps & shim::kHardwareStamps) == 0) arrival.hardware = shim::kNoStamp;
  arrival.length = static_cast<std::uint32_t>(datagram.payload.size());
  name_by_family(socket, arrival);
  socket.arrived_bytes += datagram.payload.size();
  socket.arrived.push_back(std::move(datagram));
  socket.on_arrival();
}

void queue_error(UdpSocket& socket, QueuedDatagram datagram) {
  if (socket.error_queue.size() == UdpSocket::kMostQueued) return;
  name_by_family(socket, datagram.arrival);
  socket.error_queue.push_back(std::move(datagram));
  socket.on_arrival();
}

int readiness_of(const UdpSocket& socket) {
  const bool has_error = socket.error != 0 || !socket.error_queue.empty();
  const bool has_input = !socket.arrived.empty() || (socket.is_shut & kShutForReading) != 0;
  int events = POLLOUT;
  if (has_error) events |= POLLERR | (socket.has_urgent_errors ? POLLPRI : 0);
  if (has_input) events |= POLLIN;
  if ((socket.is_shut & kShutForReading) != 0) events |= POLLRDHUP;
  if (socket.is_shut == (kShutForReading | kShutForWriting)) events |= POLLHUP;
  return events;
}

namespace {

// The next of the error queue is the error that is pending, if it is a refusal
// (sock_dequeue_err_skb()).
TakenDatagram take_from_error_queue(UdpSocket& socket, bool leaves_it) {
  if (socket.error_queue.empty()) return {.error = EAGAIN};
  if (leaves_it) return {.datagram = socket.error_queue.front()};
  TakenDatagram taken{.datagram = std::move(socket.error_queue.front())};
  socket.error_queue.pop_front();
  const bool has_next = !socket.error_queue.empty() && is_refusal(socket.error_queue.front());
  if (has_next) {
    socket.error = socket.error_queue.front().arrival.error;
  } else if (is_refusal(taken.datagram)) {
    socket.error = 0;
  }
  return taken;
}

}  // namespace

TakenDatagram take_datagram(UdpSocket& socket, std::int64_t how) {
  const bool leaves_it = (how & shim::kLeaveIt) != 0;
  if ((how & shim::kFromErrorQueue) != 0) return take_from_error_queue(socket, leaves_it);
  if (socket.error != 0) return {.error = take_error(socket)};
  if (socket.arrived.empty()) {
    const bool has_ended = (socket.is_shut & kShutForReading) != 0 && (how & shim::kMayWait) != 0;
    return {.error = has_ended ? ESHUTDOWN : EAGAIN};
  }
  if (leaves_it) return {.datagram = socket.arrived.front()};
  TakenDatagram taken{.datagram = std::move(socket.arrived.front())};
  socket.arrived.pop_front();
  socket.arrived_bytes -= taken.datagram.payload.size();
  return taken;
}

int take_error(UdpSocket& socket) { return std::exchange(socket.error, 0); }

namespace {

// Options of which IPv4 and IPv6 have one each; false for others.
bool set_ip_option(IpOptions& options, shim::SocketOption option, std::int64_t value) {
  switch (option) {
    case shim::SocketOption::kAllGroups:
      options.takes_all_groups = value != 0;
      return true;
    case shim::SocketOption::kLoopGroups:
      options.hears_itself = value != 0;
      return true;
    case shim::SocketOption::kGroupInterface:
      options.group_interface = static_cast<std::uint32_t>(value);
      return true;
    case shim::SocketOption::kHops:
      options.hops = static_cast<std::uint8_t>(value);
      return true;
    case shim::SocketOption::kGroupHops:
      options.group_hops = static_cast<std::uint8_t>(value);
      return true;
    case shim::SocketOption::kTrafficClass:
      options.traffic_class = static_cast<std::uint8_t>(value);
      return true;
    case shim::SocketOption::kMtuDiscovery:
      options.mtu_discovery = static_cast<int>(value);
      return true;
    case shim::SocketOption::kDontFragment:
      options.never_fragments = value != 0;
      return true;
    case shim::SocketOption::kReceiveErrors:
      options.receives_errors = value != 0;
      return true;
    default:
      return false;
  }
}

}  // namespace

int set_socket_option(UdpSocket& socket, std::int64_t option, std::int64_t value) {
  const bool is_ipv4 = (option & shim::kOfIpv6) == 0;
  const auto known = static_cast<shim::SocketOption>(option & ~shim::kOfIpv6);
  if (set_ip_option(socket.options(is_ipv4), known, value)) {
    const bool forgets = known == shim::SocketOption::kReceiveErrors && value == 0;
    if (forgets) socket.error_queue.clear();
    return 0;
  }
  switch (known) {
    case shim::SocketOption::kReceiveStamps:
      socket.arrival_stamps = static_cast<unsigned>(value);
      return 0;
    case shim::SocketOption::kTransmitStamps:
      socket.departure_stamps = static_cast<unsigned>(value);
      return 0;
    case shim::SocketOption::kReuseAddress:
      socket.shares_port = value != 0;
      return 0;
    case shim::SocketOption::kBroadcast:
      socket.may_broadcast = value != 0;
      return 0;
    case shim::SocketOption::kUrgentErrors:
      socket.has_urgent_errors = value != 0;
      return 0;
    case shim::SocketOption::kInterface:
      socket.interface = static_cast<std::uint32_t>(value);
      return 0;
    case shim::SocketOption::kOnlyIpv6:
      // Not once it has a port (do_ipv6_setsockopt()).
      if (socket.local.port != 0) return EINVAL;
      socket.only_ipv6 = value != 0;
      return 0;
    case shim::SocketOption::kIgnoreOutgoing:
      if (!socket.packet) return ENOPROTOOPT;
      socket.packet->ignores_outgoing = value != 0;
      return 0;
    default:
      return ENOPROTOOPT;
  }
}

}  // namespace simbench::sim
