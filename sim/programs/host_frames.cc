#include "sim/programs/host_frames.h"

#include <linux/if_ether.h>
#include <linux/if_packet.h>

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cerrno>
#include <cstring>
#include <utility>

#include "processes/placeholders.h"
#include "shim/addresses.h"

namespace simbench::sim {
namespace {

using shim::kFirstCard;
using shim::kLoopbackInterface;

constexpr std::uint16_t kLeastProtocol = 0x0600;  // below it stands the length of an 802.2 packet

bool is_group_address(const std::array<std::uint8_t, 6>& address) { return (address[0] & 1) != 0; }

// What no bridge forwards.
bool is_for_link(const std::array<std::uint8_t, 6>& address) {
  constexpr std::array<std::uint8_t, 5> kReserved{0x01, 0x80, 0xC2, 0x00, 0x00};
  return std::equal(kReserved.begin(), kReserved.end(), address.begin()) && address[5] <= 0x0F;
}

std::uint64_t number_of(const std::array<std::uint8_t, 6>& address) {
  std::uint64_t number = 0;
  for (const std::uint8_t byte : address) number = number << 8 | byte;
  return number;
}

std::array<std::uint8_t, 6> card_in(const shim::Address& address) {
  return std::to_array(shim::unpacked(address.host).card);
}

shim::Address packet_address(const std::array<std::uint8_t, 6>& card, std::uint8_t kind,
                             std::uint32_t interface, std::uint16_t protocol) {
  shim::PacketAddress host{.kind = kind};
  std::memcpy(host.card, card.data(), card.size());
  return {.host = shim::packed(host), .scope = interface, .port = protocol, .family = AF_PACKET};
}

std::uint16_t protocol_of(const Bytes& frame) {
  const auto stated = boost::endian::load_big_u16(
      reinterpret_cast<const unsigned char*>(frame.data()) + 2 * sizeof(std::array<char, 6>));
  return stated >= kLeastProtocol ? stated : ETH_P_802_2;
}

}  // namespace

HostFrames::HostFrames(SimHost& host, PacketSender& sender, std::size_t hosts)
    : host_(host),
      sender_(sender),
      hosts_(hosts),
      ipv4_(processes::address_of(host.id())),
      cables_(host.world().hosts, host.world().network_parameters, host.id(), hosts) {}

void HostFrames::open(UdpSocket& socket) {
  sender_.enrol(socket);
  sockets_.push_back(&socket);
  bind(socket, socket.local);
}

void HostFrames::close(UdpSocket& socket) {
  sender_.dismiss(socket);
  std::erase(sockets_, &socket);
}

bool HostFrames::is_interface(std::uint32_t number) const {
  return number >= kLoopbackInterface && number < kFirstCard + cables_.cards();
}

HostFrames::CardAddress HostFrames::card_address(std::uint32_t interface) const {
  std::uint8_t card[6] = {};
  if (interface >= kFirstCard) shim::write_card_address(ipv4_, interface - kFirstCard, card);
  return std::to_array(card);
}

int HostFrames::bind(UdpSocket& socket, const shim::Address& address) {
  if (address.scope != 0 && !is_interface(address.scope)) return ENODEV;
  PacketPart& part = *socket.packet;
  part.interface = address.scope;
  if (address.port != 0) part.protocol = address.port;
  socket.local = packet_address(card_address(part.interface), 0, part.interface, part.protocol);
  return 0;
}

int HostFrames::join(UdpSocket& socket, bool joins, int kind, const shim::Address& group) {
  if (!is_interface(group.scope)) return ENODEV;
  const PacketPart::Membership wanted{
      .kind = kind, .interface = group.scope, .group = shim::unpacked(group.host)};
  std::vector<PacketPart::Membership>& all = socket.packet->memberships;
  if (joins) {
    if (kind < PACKET_MR_MULTICAST || kind > PACKET_MR_UNICAST) return EINVAL;
    all.push_back(wanted);
    return 0;
  }
  const auto found = std::ranges::find_if(all, [&](const PacketPart::Membership& each) {
    return each.kind == kind && each.interface == wanted.interface &&
           std::memcmp(each.group.card, wanted.group.card, sizeof each.group.card) == 0;
  });
  if (found == all.end()) return EADDRNOTAVAIL;
  all.erase(found);
  return 0;
}

std::uint8_t HostFrames::kind_of(std::uint32_t interface, const CardAddress& to) const {
  CardAddress all{};
  all.fill(0xFF);
  if (to == all) return PACKET_BROADCAST;
  if (is_group_address(to)) return PACKET_MULTICAST;
  return to == card_address(interface) ? PACKET_HOST : PACKET_OTHERHOST;
}

bool HostFrames::takes(std::uint32_t interface, std::uint8_t kind, const CardAddress& to) const {
  if (kind == PACKET_HOST || kind == PACKET_BROADCAST) return true;
  const auto wants = [&](const PacketPart::Membership& each) {
    if (each.interface != interface) return false;
    const bool is_named = std::memcmp(each.group.card, to.data(), to.size()) == 0;
    return each.kind == PACKET_MR_PROMISC ||
           (each.kind == PACKET_MR_ALLMULTI && kind == PACKET_MULTICAST) || is_named;
  };
  return std::ranges::any_of(sockets_, [&](const UdpSocket* socket) {
    return std::ranges::any_of(socket->packet->memberships, wants);
  });
}

QueuedDatagram HostFrames::queued(const Seen& seen) {
  return {.arrival = {.from = packet_address(seen.from, seen.kind, seen.interface, seen.protocol),
                      .system = seen.system,
                      .hardware = seen.hardware,
                      .length = static_cast<std::uint32_t>(seen.frame.size()),
                      .interface = seen.interface,
                      .info = static_cast<std::uint32_t>(seen.frame.size())},
          .payload = seen.frame};
}

// To those that asked for the protocol; what the host sends itself is for those of all protocols.
void HostFrames::deliver(const Seen& seen, const UdpSocket* sender) {
  for (UdpSocket* each : sockets_) {
    const PacketPart& part = *each->packet;
    if (part.interface != 0 && part.interface != seen.interface) continue;
    const bool takes_all = part.protocol == ETH_P_ALL;
    if (seen.kind == PACKET_OUTGOING) {
      if (!takes_all || each == sender || part.ignores_outgoing) continue;
    } else if (!takes_all && part.protocol != seen.protocol) {
      continue;
    }
    queue_arrival(*each, queued(seen));
  }
}

int HostFrames::build_frame(const UdpSocket& socket, std::uint32_t interface,
                            const shim::Address& to, Bytes data, Seen& seen) const {
  const bool has_head = socket.packet->has_link_heads;
  const std::size_t mtu =
      interface == kLoopbackInterface ? shim::kLoopbackMtu : std::size_t{shim::kLinkMtu};
  if (data.size() > mtu + (has_head ? kEthernetHead : 0)) return EMSGSIZE;
  if (has_head && data.size() < kEthernetHead) return EINVAL;
  if (!has_head) {
    Bytes head(kEthernetHead);
    const CardAddress card = card_in(to);
    const CardAddress own = card_address(interface);
    std::memcpy(head.data(), card.data(), card.size());
    std::memcpy(head.data() + card.size(), own.data(), own.size());
    const std::uint16_t protocol = to.family != AF_UNSPEC ? to.port : socket.packet->protocol;
    boost::endian::store_big_u16(reinterpret_cast<unsigned char*>(head.data()) + 12, protocol);
    data.insert(data.begin(), head.begin(), head.end());
  }
  seen.interface = interface;
  std::memcpy(seen.from.data(), data.data() + seen.from.size(), seen.from.size());
  seen.protocol = protocol_of(data);
  seen.kind = PACKET_OUTGOING;
  seen.system = sender_.stamp_now();
  seen.frame = std::move(data);
  return 0;
}

std::optional<PeerId> HostFrames::owner_of(const CardAddress& address) const {
  const std::uint32_t ipv4 = boost::endian::load_big_u32(address.data() + 2);
  const std::uint32_t host = ipv4 - processes::kFirstAddress;
  if (address[0] != 0x02 || address[1] != 0 || host >= hosts_) return std::nullopt;
  return host;
}

PacketSender::Way HostFrames::way_of(std::uint32_t card, const CardAddress& to) const {
  if (card > 0 || is_for_link(to)) {
    const std::optional<PeerId> neighbour = cables_.neighbour(card);
    // A group that nobody joins: it leaves the host, and the switch drops it.
    if (!neighbour) return {.group = Groups::of_ethernet(number_of(to))};
    return {.peer = neighbour};
  }
  const std::optional<PeerId> peer = owner_of(to);
  if (is_group_address(to) || !peer) return {.group = Groups::kEveryone};
  if (*peer == host_.id()) return {.group = Groups::of_ethernet(number_of(to))};
  return {.peer = peer};
}

Task<int> HostFrames::send(UdpSocket& socket, shim::Address to, Bytes data, unsigned stamps) {
  const bool is_named = to.family != AF_UNSPEC;
  const std::uint32_t interface = is_named ? to.scope : socket.packet->interface;
  if (!is_interface(interface)) co_return ENXIO;
  Seen seen;
  const int error = build_frame(socket, interface, to, std::move(data), seen);
  if (error != 0) co_return error;
  if (socket.error != 0) co_return take_error(socket);
  QueuedDatagram told = queued(seen);
  if (stamps != 0) told.arrival.number = socket.sent++;
  CardAddress target{};
  std::memcpy(target.data(), seen.frame.data(), target.size());
  deliver(seen, &socket);
  if (interface == kLoopbackInterface) {
    seen.kind = kind_of(interface, target);
    deliver(seen, nullptr);
    sender_.stamp_at_once(socket, stamps, std::move(told));
    co_return 0;
  }
  const std::uint32_t card = interface - kFirstCard;
  if ((cables_.carriers() & (1U << card)) == 0) co_return 0;  // nothing leaves
  const PacketSender::Way way = way_of(card, target);
  WirePacket packet{
      .head = {.kind = PacketKind::kFrame,
               .is_on_link = card > 0 || is_for_link(target) ? std::uint8_t{1} : std::uint8_t{0}},
      .payload = Bytes(seen.frame.begin() + kEthernetHead, seen.frame.end())};
  // The protocol as it is stated, which may be a length.
  const std::uint16_t stated =
      boost::endian::load_big_u16(reinterpret_cast<const unsigned char*>(seen.frame.data()) + 12);
  packet.head.from = packet_address(seen.from, 0, interface, stated);
  packet.head.to = packet_address(target, 0, interface, stated);
  co_await sender_.send(socket.number, way, std::move(packet), stamps, std::move(told));
  co_return 0;
}

void HostFrames::take(PeerId from, WirePacket packet) {
  std::uint32_t interface = kFirstCard;
  if (packet.head.is_on_link != 0) interface += cables_.card_to(from).value_or(0);
  const CardAddress to = card_in(packet.head.to);
  const std::uint8_t kind = kind_of(interface, to);
  if (!takes(interface, kind, to)) return;
  Bytes frame(kEthernetHead);
  const CardAddress sender = card_in(packet.head.from);
  std::memcpy(frame.data(), to.data(), to.size());
  std::memcpy(frame.data() + to.size(), sender.data(), sender.size());
  boost::endian::store_big_u16(reinterpret_cast<unsigned char*>(frame.data()) + 12,
                               packet.head.to.port);
  frame.insert(frame.end(), packet.payload.begin(), packet.payload.end());
  frame.resize(std::max(frame.size(), kEthernetHead + kLeastFramePayload));
  Seen seen{.interface = interface,
            .kind = kind,
            .from = sender,
            .frame = std::move(frame),
            .system = packet.system,
            .hardware = packet.hardware};
  seen.protocol = protocol_of(seen.frame);
  deliver(seen, nullptr);
}

}  // namespace simbench::sim
