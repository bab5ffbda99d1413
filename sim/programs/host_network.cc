#include "sim/programs/host_network.h"

#include <linux/errqueue.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "shim/addresses.h"
#include "sim/host/sim_channel.h"

namespace simbench::sim {
namespace {

using shim::Address;
using shim::kFirstCard;

constexpr std::size_t kMostIpv6Groups = 128;  // of a socket

constexpr Address all_hosts(bool is_ipv4) {
  Address group{.host = shim::mapped(0xE0000001), .scope = kFirstCard, .family = AF_INET};
  if (is_ipv4) return group;
  group.host = shim::small_address(1);
  group.host.bytes[0] = 0xFF;
  group.host.bytes[1] = 0x02;
  group.family = AF_INET6;
  return group;
}

bool is_for(const UdpSocket& socket, const shim::Arrival& arrival) {
  const shim::IpAddress& to = arrival.to.host;
  if (socket.local.port != arrival.to.port) return false;
  if (socket.interface != 0 && socket.interface != arrival.interface) return false;
  const bool is_ipv4 = shim::is_ipv4(to);
  if (is_ipv4 ? socket.family == AF_INET6 && socket.only_ipv6 : socket.family == AF_INET) {
    return false;
  }
  const shim::IpAddress& local = socket.local.host;
  const bool takes_any = shim::is_small(local, 0) || (is_ipv4 && shim::is_any(local));
  if (!takes_any && local != to) return false;
  return !socket.peer ||
         (socket.peer->host == arrival.from.host && socket.peer->port == arrival.from.port);
}

// How much of the addresses it states (compute_score()).
int score_of(const UdpSocket& socket) {
  return (shim::is_any(socket.local.host) ? 0 : 8) + (socket.peer ? 4 : 0) +
         (socket.interface != 0 ? 2 : 0) + (socket.family == AF_INET ? 1 : 0);
}

}  // namespace

HostNetwork::HostNetwork(SimHost& host, std::size_t hosts)
    : host_(host),
      hosts_(hosts),
      routes_(host.id(), hosts),
      sender_(host),
      frames_(host, sender_, hosts),
      has_refused_(host.world().context, host.name("datagrams that nobody takes")),
      streams_(host, hosts) {
  host_.world().network.groups().join(Groups::kEveryone, host_.id());
  for (const bool is_ipv4 : {true, false}) count_member(all_hosts(is_ipv4), 1);
}

// Names.

void HostNetwork::open(UdpSocket& socket) {
  if (socket.packet) return frames_.open(socket);
  socket.local.family = static_cast<std::uint16_t>(socket.family);
  if (socket.family == AF_INET) socket.local.host = shim::mapped(0);
  // Linux begins so (inet6_create()).
  socket.ipv4.takes_all_groups = socket.family == AF_INET;
  sender_.enrol(socket);
}

bool HostNetwork::is_taken(const Address& address, const UdpSocket& by) const {
  return std::ranges::any_of(bound_, [&](const UdpSocket* each) {
    return each != &by && each->local.port == address.port &&
           !(each->shares_port && by.shares_port) &&
           overlap({.host = address.host, .only_ipv6 = by.only_ipv6, .interface = by.interface},
                   {.host = each->local.host,
                    .only_ipv6 = each->only_ipv6,
                    .interface = each->interface});
  });
}

int HostNetwork::bind(UdpSocket& socket, Address address) {
  if (socket.packet) return frames_.bind(socket, address);
  if (socket.local.port != 0) return EINVAL;
  if (socket.family == AF_INET && !shim::is_ipv4(address.host)) return EAFNOSUPPORT;
  const int obstacle = routes_.check_own(address, socket.only_ipv6, socket.interface);
  const bool is_for_many = shim::is_group(address.host) || Routes::is_broadcast(address.host);
  if (obstacle != 0 && !(obstacle == EADDRNOTAVAIL && is_for_many)) return obstacle;
  if (address.port != 0 && is_taken(address, socket)) return EADDRINUSE;
  socket.states_port = address.port != 0;
  socket.states_host = !shim::is_any(address.host);
  if (address.scope != 0) socket.interface = address.scope;
  return bind_to(socket, address);
}

int HostNetwork::bind_to(UdpSocket& socket, Address address) {
  const int error = address.port == 0 ? ports_.give(address, bound_) : 0;
  if (error != 0) return error;
  socket.local = address;
  socket.local.family = static_cast<std::uint16_t>(socket.family);
  bound_.push_back(&socket);
  return 0;
}

void HostNetwork::dissolve(UdpSocket& socket) {
  socket.peer.reset();
  socket.interface = 0;
  if (!socket.states_host) {
    socket.local.host = socket.family == AF_INET ? shim::mapped(0) : shim::IpAddress{};
    socket.local.scope = 0;
  }
  if (socket.states_port) return;
  socket.local.port = 0;
  std::erase(bound_, &socket);
}

Route HostNetwork::route_of(const UdpSocket& socket, const shim::Departure& departure,
                            bool is_connect) const {
  const shim::IpAddress& to = departure.to.host;
  const bool is_ipv4 = shim::is_ipv4(to);
  if (!is_ipv4 && socket.family == AF_INET) return {.error = EAFNOSUPPORT};
  if (is_ipv4 && socket.only_ipv6) return {.error = ENETUNREACH};
  const shim::IpAddress& local = socket.local.host;
  const bool states_host = !shim::is_any(local);
  if (states_host && is_ipv4 && !shim::is_ipv4(local)) return {.error = ENETUNREACH};
  if (Routes::is_broadcast(to) && !socket.may_broadcast) return {.error = EACCES};
  Routes::Wish wish{.interface = socket.interface,
                    .group_interface = socket.options(is_ipv4).group_interface,
                    .must_name_link = is_connect};
  if (departure.source.scope != 0) wish.interface = departure.source.scope;
  Route route = routes_.to(departure.to, wish);
  if (route.error != 0) return route;
  if (!is_ipv4 && shim::is_ipv4(local)) return {.error = EAFNOSUPPORT};
  if (states_host) route.source = local;
  const bool states_source =
      departure.source.family != AF_UNSPEC && !shim::is_any(departure.source.host);
  if (states_source && !routes_.is_own(departure.source.host)) return {.error = EINVAL};
  if (states_source) route.source = departure.source.host;
  const bool leaves = route.peer || route.group;
  if (is_ipv4 && leaves && shim::is_loopback(route.source)) return {.error = EINVAL};
  return route;
}

int HostNetwork::connect(UdpSocket& socket, Address peer) {
  if (socket.packet) return EOPNOTSUPP;
  if (peer.family == AF_UNSPEC) {
    dissolve(socket);
    return 0;
  }
  if (socket.local.port == 0) {
    const int error = bind_to(socket, socket.local);
    if (error != 0) return error;
  }
  const Route route = route_of(socket, {.to = peer}, true);
  if (route.error != 0) return route.error;
  if (shim::is_any(peer.host)) {
    peer.host = shim::is_ipv4(peer.host) ? shim::mapped(INADDR_LOOPBACK) : shim::kLoopback6;
  }
  peer.family = static_cast<std::uint16_t>(socket.family);
  socket.peer = scoped(peer, route.interface);
  if (shim::needs_scope(peer.host)) socket.interface = route.interface;
  if (shim::is_any(socket.local.host)) {
    socket.local.host = route.source;
    socket.local = scoped(socket.local, route.interface);
  }
  return 0;
}

int HostNetwork::shut_down(UdpSocket& socket, int how) {
  if (how < SHUT_RD || how > SHUT_RDWR) return EINVAL;
  if (socket.packet) return EOPNOTSUPP;
  socket.is_shut |= how + 1;
  socket.on_arrival();
  return socket.peer ? 0 : ENOTCONN;
}

void HostNetwork::close(UdpSocket& socket) {
  if (socket.packet) return frames_.close(socket);
  while (!socket.groups.empty()) leave_group(socket, Address(socket.groups.back()));
  sender_.dismiss(socket);
  std::erase(bound_, &socket);
}

// Groups.

int HostNetwork::joined(const Address& group) const {
  const auto found = std::ranges::find(members_, group, &Membership::group);
  return found == members_.end() ? 0 : found->sockets;
}

void HostNetwork::count_member(const Address& group, int change) {
  auto found = std::ranges::find(members_, group, &Membership::group);
  if (found == members_.end()) found = members_.insert(found, {.group = group});
  found->sockets += change;
  Groups& groups = host_.world().network.groups();
  const Groups::Id id = Routes::group_of(group.host);
  const bool is_first = change > 0 && found->sockets == 1;
  if (found->sockets == 0) {
    members_.erase(found);
    // Two groups of IPv6 may share an Ethernet address.
    const bool is_last = std::ranges::none_of(
        members_, [&](const Membership& each) { return Routes::group_of(each.group.host) == id; });
    if (is_last) groups.leave(id, host_.id());
  } else if (is_first) {
    groups.join(id, host_.id());
  }
}

int HostNetwork::join(UdpSocket& socket, bool joins, int kind, Address group) {
  if (socket.packet) return frames_.join(socket, joins, kind, group);
  if (!shim::is_group(group.host)) return joins ? EINVAL : EADDRNOTAVAIL;
  if (group.scope == 0) group.scope = kFirstCard;
  if (group.scope != kFirstCard) return ENODEV;
  group.port = 0;
  group.family = shim::is_ipv4(group.host) ? AF_INET : AF_INET6;
  return joins ? join_group(socket, group) : leave_group(socket, group);
}

int HostNetwork::join_group(UdpSocket& socket, Address group) {
  if (std::ranges::find(socket.groups, group) != socket.groups.end()) return EADDRINUSE;
  const bool is_ipv4 = shim::is_ipv4(group.host);
  const auto others = std::ranges::count_if(
      socket.groups, [&](const Address& each) { return shim::is_ipv4(each.host) == is_ipv4; });
  if (static_cast<std::size_t>(others) == (is_ipv4 ? kMostGroups : kMostIpv6Groups)) {
    return is_ipv4 ? ENOBUFS : ENOMEM;
  }
  socket.groups.push_back(group);
  count_member(group, 1);
  return 0;
}

int HostNetwork::leave_group(UdpSocket& socket, const Address& group) {
  if (std::erase(socket.groups, group) == 0) return EADDRNOTAVAIL;
  count_member(group, -1);
  return 0;
}

// Sending.

int HostNetwork::check_size(UdpSocket& socket, const shim::Departure& departure, const Route& route,
                            std::size_t size) const {
  const bool is_ipv4 = shim::is_ipv4(departure.to.host);
  if (size > most_payload(is_ipv4)) return EMSGSIZE;
  const IpOptions& options = socket.options(is_ipv4);
  const bool may_fragment =
      options.mtu_discovery < IP_PMTUDISC_DO || options.mtu_discovery == IP_PMTUDISC_OMIT;
  const bool leaves = route.peer || route.group;
  const std::uint32_t mtu = leaves ? shim::kLinkMtu : shim::kLoopbackMtu;
  if ((may_fragment && !options.never_fragments) || size <= most_in_one_packet(is_ipv4, mtu)) {
    return 0;
  }
  if (options.receives_errors) {
    queue_error(socket, {.arrival = {.to = departure.to,
                                     .interface = route.interface,
                                     .info = mtu,
                                     .error = EMSGSIZE,
                                     .origin = SO_EE_ORIGIN_LOCAL},
                         .payload = {}});
  }
  return EMSGSIZE;
}

WirePacket HostNetwork::packet_for(const UdpSocket& socket, const shim::Departure& departure,
                                   const Route& route, Bytes payload) {
  const IpOptions& options = socket.options(shim::is_ipv4(departure.to.host));
  WirePacket packet{
      .head = {.hops = route.group ? options.group_hops : options.hops,
               .traffic_class = options.traffic_class,
               .from = scoped({.host = route.source, .port = socket.local.port}, route.interface),
               .to = scoped(departure.to, route.interface)},
      .payload = std::move(payload)};
  if (shim::is_any(packet.head.to.host)) packet.head.to.host = route.source;
  return packet;
}

Task<int> HostNetwork::send(UdpSocket& socket, shim::Departure departure, Bytes payload,
                            unsigned stamps) {
  if (socket.packet) {
    co_return co_await frames_.send(socket, departure.to, std::move(payload), stamps);
  }
  if (payload.size() > UINT16_MAX) co_return EMSGSIZE;
  if (departure.to.family == AF_UNSPEC) {
    if (!socket.peer) co_return EDESTADDRREQ;
    departure.to = *socket.peer;
  } else if (departure.to.port == 0) {
    co_return EINVAL;
  }
  if (socket.local.port == 0) {
    const int error = bind_to(socket, socket.local);
    if (error != 0) co_return error;
  }
  const Route route = route_of(socket, departure, false);
  if (route.error != 0) co_return route.error;
  const int obstacle = check_size(socket, departure, route, payload.size());
  if (obstacle != 0) co_return obstacle;
  if (socket.error != 0) co_return take_error(socket);
  if ((socket.is_shut & (SHUT_WR + 1)) != 0) co_return EPIPE;
  WirePacket packet = packet_for(socket, departure, route, std::move(payload));
  co_await transmit(socket, route, std::move(packet), stamps);
  co_return 0;
}

QueuedDatagram HostNetwork::arrived(const WirePacket& packet, std::uint32_t interface) {
  return {.arrival = {.from = scoped(packet.head.from, interface),
                      .to = scoped(packet.head.to, interface),
                      .system = packet.system,
                      .hardware = packet.hardware,
                      .length = static_cast<std::uint32_t>(packet.payload.size()),
                      .interface = interface,
                      .hops = packet.head.hops,
                      .traffic_class = packet.head.traffic_class},
          .payload = packet.payload};
}

// A message to a group that has no hops left, or is for the host's own interface. Linux drops one
// of IPv6 without hops only where the host has heard it itself (ip6_finish_output2()).
bool HostNetwork::stays_on_host(const PacketHead& head, bool loops) const {
  const Address& to = head.to;
  if (shim::is_ipv4(to.host)) return head.hops == 0;
  const bool is_of_interface = (to.host.bytes[1] & 0x0F) <= 1;
  const Address group{.host = to.host, .scope = kFirstCard, .family = AF_INET6};
  return is_of_interface || (head.hops == 0 && loops && joined(group) > 0);
}

Task<void> HostNetwork::transmit(UdpSocket& socket, const Route& route, WirePacket packet,
                                 unsigned stamps) {
  QueuedDatagram told = arrived(packet, route.interface);
  if (stamps != 0) told.arrival.number = socket.sent++;
  if (!route.peer && !route.group) {
    packet.system = sender_.stamp_now();
    const QueuedDatagram looped = arrived(packet, route.interface);
    sender_.stamp_at_once(socket, stamps, std::move(told));
    if (!deliver(looped)) {
      take_refusal(looped.arrival.to, looped.arrival.from, std::move(packet.payload));
    }
    co_return;
  }
  const shim::IpAddress& to = packet.head.to.host;
  const bool is_ipv4 = shim::is_ipv4(to);
  const bool is_broadcast = Routes::is_broadcast(to);
  const bool loops = route.group && (is_broadcast || socket.options(is_ipv4).hears_itself);
  const bool stays = route.group && !is_broadcast && stays_on_host(packet.head, loops);
  // What it hears is of the first fragment alone.
  if (told.payload.size() > most_in_one_packet(is_ipv4, shim::kLinkMtu)) {
    told.payload.resize(most_in_first_fragment(is_ipv4));
  }
  QueuedDatagram looped = arrived(packet, route.interface);
  packet.head.number = ++datagrams_;
  if (!stays) {
    const PacketSender::Way way{.peer = route.peer, .group = route.group.value_or(0)};
    co_await sender_.send(socket.number, way, std::move(packet), stamps, std::move(told));
  }
  looped.arrival.system = sender_.stamp_now();
  if (loops) deliver_to_all(looped);
}

// Receiving.

UdpSocket* HostNetwork::socket_for(const shim::Arrival& arrival) const {
  UdpSocket* best = nullptr;
  for (UdpSocket* each : bound_) {
    if (!is_for(*each, arrival)) continue;
    if (best == nullptr || score_of(*each) >= score_of(*best)) best = each;
  }
  return best;
}

bool HostNetwork::deliver(const QueuedDatagram& datagram) {
  UdpSocket* socket = socket_for(datagram.arrival);
  if (socket != nullptr) queue_arrival(*socket, datagram);
  return socket != nullptr;
}

void HostNetwork::deliver_to_all(const QueuedDatagram& datagram) {
  const Address& to = datagram.arrival.to;
  const bool is_ipv4 = shim::is_ipv4(to.host);
  const Address group{.host = to.host,
                      .scope = datagram.arrival.interface,
                      .family = static_cast<std::uint16_t>(is_ipv4 ? AF_INET : AF_INET6)};
  for (UdpSocket* each : bound_) {
    if (!is_for(*each, datagram.arrival)) continue;
    const bool takes = !shim::is_group(to.host) ||
                       std::ranges::find(each->groups, group) != each->groups.end() ||
                       (each->options(is_ipv4).takes_all_groups && joined(group) > 0);
    if (takes) queue_arrival(*each, datagram);
  }
}

void HostNetwork::take_refusal(const Address& from, const Address& to, Bytes quoted) {
  UdpSocket* socket = socket_for({.from = from, .to = to, .interface = kFirstCard});
  if (socket == nullptr && shim::is_loopback(to.host)) {
    socket = socket_for({.from = from, .to = to, .interface = shim::kLoopbackInterface});
  }
  if (socket == nullptr) return;
  const bool is_ipv4 = shim::is_ipv4(from.host);
  const bool receives_errors = socket->options(is_ipv4).receives_errors;
  if (!receives_errors && !socket->peer) return;
  socket->error = ECONNREFUSED;
  if (!receives_errors) return socket->on_arrival();
  quoted.resize(std::min(quoted.size(), most_quoted(is_ipv4)));
  queue_error(*socket,
              {.arrival = {.from = to,
                           .to = from,
                           .interface =
                               shim::is_loopback(from.host) ? shim::kLoopbackInterface : kFirstCard,
                           .error = ECONNREFUSED,
                           .origin = static_cast<std::uint8_t>(is_ipv4 ? SO_EE_ORIGIN_ICMP
                                                                       : SO_EE_ORIGIN_ICMP6)},
               .payload = std::move(quoted)});
}

bool HostNetwork::may_answer(PeerId peer, bool is_ipv4) {
  constexpr double kAtOnce = 6;
  const SteadyTime now = host_.steady_clock().now();
  Allowance& allowance = allowances_[{peer, is_ipv4}];
  const double a_second = is_ipv4 ? 1 : 4;
  allowance.answers =
      std::min(kAtOnce, allowance.answers + a_second * to_seconds(now - allowance.since));
  allowance.since = now;
  if (allowance.answers < 1) return false;
  allowance.answers -= 1;
  return true;
}

void HostNetwork::take(PeerId peer, WirePacket packet) {
  const Address to = packet.head.to;
  const QueuedDatagram datagram = arrived(packet, kFirstCard);
  if (shim::is_group(to.host) || Routes::is_broadcast(to.host)) return deliver_to_all(datagram);
  const bool is_ipv4 = shim::is_ipv4(to.host);
  if (deliver(datagram) || !may_answer(peer, is_ipv4)) return;
  packet.payload.resize(std::min(packet.payload.size(), most_quoted(is_ipv4)));
  refusals_.push_back({.head = {.kind = PacketKind::kRefusal, .from = to, .to = packet.head.from},
                       .payload = std::move(packet.payload)});
  has_refused_.notify();
}

Task<void> HostNetwork::answer_refused() {
  for (;;) {
    while (refusals_.empty()) co_await has_refused_.wait();
    WirePacket refusal = std::move(refusals_.front());
    refusals_.pop_front();
    const std::optional<PeerId> peer = owner_of(refusal.head.to.host, hosts_);
    if (!peer) continue;
    co_await sender_.send(0, {.peer = peer}, std::move(refusal), 0, {});
  }
}

Task<void> HostNetwork::pump(PeerId peer) {
  SimChannel& channel = host_.datagram_channel(peer);
  for (;;) {
    std::optional<ReceivedMessage> message =
        co_await channel.receive(host_.steady_clock().now() + kIdle);
    if (!message) continue;
    std::optional<WirePacket> packet = packet_of(std::move(message->bytes));
    if (!packet) continue;
    packet->system = stamp_of(message->received);
    if (card_stamping().arrivals) packet->hardware = stamp_of(message->received_hardware);
    switch (packet->head.kind) {
      case PacketKind::kFrame:
        frames_.take(peer, *std::move(packet));
        break;
      case PacketKind::kRefusal:
        take_refusal(packet->head.from, packet->head.to, std::move(packet->payload));
        break;
      case PacketKind::kDatagram:
        packet = reassembly_.add(peer, *std::move(packet), host_.steady_clock().now());
        if (packet) take(peer, *std::move(packet));
        break;
    }
  }
}

}  // namespace simbench::sim
