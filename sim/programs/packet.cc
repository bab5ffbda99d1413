#include "sim/programs/packet.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "shim/addresses.h"

namespace simbench::sim {
namespace {

constexpr std::size_t kIcmpHead = 8;
constexpr std::size_t kIpv4Head = 20;
constexpr std::size_t kIpv6Head = 40;
constexpr std::size_t kFragmentHead = 8;
constexpr std::size_t kMostIpv4 = 65'535;       // with its head
constexpr std::size_t kMostAfterIpv6 = 65'535;  // without
// What a router must carry, of which a refusal makes use (RFC 1812, 4.3.2.3; RFC 4443, 2.4).
constexpr std::size_t kQuotedIpv4 = 576;
constexpr std::size_t kQuotedIpv6 = 1280;

bool is_by_ipv4(const WirePacket& packet) { return shim::is_ipv4(packet.head.to.host); }

std::size_t ip_head(bool is_ipv4) { return is_ipv4 ? kIpv4Head : kIpv6Head; }

// What a fragment carries behind the IP head, in whole blocks of eight bytes.
std::size_t fragment_room(bool is_ipv4) {
  const std::size_t heads = ip_head(is_ipv4) + (is_ipv4 ? 0 : kFragmentHead);
  return (shim::kLinkMtu - heads) / 8 * 8;
}

}  // namespace

std::size_t most_payload(bool is_ipv4) {
  return (is_ipv4 ? kMostIpv4 - kIpv4Head : kMostAfterIpv6) - kUdpHead;
}

std::size_t most_in_one_packet(bool is_ipv4, std::size_t mtu) {
  return std::min(mtu - ip_head(is_ipv4) - kUdpHead, most_payload(is_ipv4));
}

std::size_t most_in_first_fragment(bool is_ipv4) { return fragment_room(is_ipv4) - kUdpHead; }

std::size_t most_quoted(bool is_ipv4) {
  const std::size_t most = is_ipv4 ? kQuotedIpv4 : kQuotedIpv6;
  return most - 2 * ip_head(is_ipv4) - kIcmpHead - kUdpHead;
}

double bytes_on_wire(const WirePacket& packet) {
  const std::size_t size = packet.payload.size();
  const bool is_ipv4 = is_by_ipv4(packet);
  const std::size_t longer = is_ipv4 ? 0 : kIpv6Head - kIpv4Head;
  switch (packet.head.kind) {
    case PacketKind::kFrame:
      return static_cast<double>(std::max(size, kLeastFramePayload) - kIpv4Head);
    case PacketKind::kRefusal:
      return static_cast<double>(longer + kIcmpHead + ip_head(is_ipv4) + kUdpHead + size);
    case PacketKind::kDatagram:
      break;
  }
  const bool is_fragment = packet.head.whole != 0;
  const std::size_t udp = packet.head.begin == 0 ? kUdpHead : 0;
  return static_cast<double>(longer + (is_fragment && !is_ipv4 ? kFragmentHead : 0) + udp + size);
}

Bytes to_message(const WirePacket& packet) {
  Bytes message = packet.payload;
  const auto head = std::as_bytes(std::span(&packet.head, 1));
  message.insert(message.end(), head.begin(), head.end());
  return message;
}

std::optional<WirePacket> packet_of(Bytes message) {
  WirePacket packet;
  if (message.size() < sizeof packet.head) return std::nullopt;
  const std::size_t size = message.size() - sizeof packet.head;
  std::memcpy(&packet.head, message.data() + size, sizeof packet.head);
  message.resize(size);
  packet.payload = std::move(message);
  return packet;
}

std::vector<WirePacket> fragments_of(WirePacket packet) {
  std::vector<WirePacket> parts;
  const bool is_ipv4 = is_by_ipv4(packet);
  const std::size_t whole = packet.payload.size();
  if (packet.head.kind != PacketKind::kDatagram ||
      whole <= most_in_one_packet(is_ipv4, shim::kLinkMtu)) {
    parts.push_back(std::move(packet));
    return parts;
  }
  const std::size_t room = fragment_room(is_ipv4);
  for (std::size_t begin = 0; begin < whole;) {
    const std::size_t most = begin == 0 ? most_in_first_fragment(is_ipv4) : room;
    const std::size_t size = std::min(whole - begin, most);
    const auto from = packet.payload.begin() + static_cast<std::ptrdiff_t>(begin);
    WirePacket part{.head = packet.head,
                    .payload = Bytes(from, from + static_cast<std::ptrdiff_t>(size))};
    part.head.begin = static_cast<std::uint32_t>(begin);
    part.head.whole = static_cast<std::uint32_t>(whole);
    parts.push_back(std::move(part));
    begin += size;
  }
  return parts;
}

void Reassembly::forget_old(SteadyTime now) {
  std::erase_if(partial_, [&](const auto& entry) {
    const Partial& each = entry.second;
    const Nanoseconds patience = from_ms(is_by_ipv4(each.datagram) ? 30e3 : 60e3);
    if (now - each.begun < patience) return false;
    bytes_ -= each.datagram.payload.size();
    return true;
  });
}

std::optional<WirePacket> Reassembly::add(PeerId from, WirePacket packet, SteadyTime now) {
  if (packet.head.whole == 0) return packet;
  forget_old(now);
  const Key key{from, packet.head.number};
  auto found = partial_.find(key);
  if (found == partial_.end()) {
    if (bytes_ + packet.head.whole > kMostBytes) return std::nullopt;
    found = partial_.emplace(key, Partial{.datagram = {.head = packet.head}, .begun = now}).first;
    found->second.datagram.payload.resize(packet.head.whole);
    bytes_ += packet.head.whole;
  }
  Partial& partial = found->second;
  const std::size_t size = packet.payload.size();
  if (packet.head.begin + size > partial.datagram.payload.size()) return std::nullopt;
  std::ranges::copy(packet.payload, partial.datagram.payload.begin() + packet.head.begin);
  partial.parts[packet.head.begin] = packet.head.begin + static_cast<std::uint32_t>(size);
  partial.datagram.system = packet.system;
  if (packet.head.begin == 0) partial.datagram.hardware = packet.hardware;
  std::uint32_t end = 0;
  for (const auto& [begin, until] : partial.parts) {
    if (begin != end) return std::nullopt;
    end = until;
  }
  if (end != partial.datagram.payload.size()) return std::nullopt;
  WirePacket whole = std::move(partial.datagram);
  whole.head.whole = 0;
  bytes_ -= whole.payload.size();
  partial_.erase(found);
  return whole;
}

}  // namespace simbench::sim
