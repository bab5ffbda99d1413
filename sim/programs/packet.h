// What passes between the cards of two hosts whose programs use the network: a datagram or a
// fragment of one, the answer that nobody takes it (ICMP), or a frame of a packet socket.
//
// Each is one message of the simulated network. What its heads say travels beside the payload, and
// what they weigh is stated: bytes_on_wire() is what the network counts of a packet, beside the
// /network/overhead_bytes that it adds to every message and that stand for Ethernet, IPv4 and what
// the line needs between frames (66 in most scenarios).
//
//   UDP over IPv4       payload + 8
//   UDP over IPv6       payload + 28: IPv6's head is 20 bytes longer
//   fragment            its part of what follows the IP head; IPv6: + 28, its fragment header too
//   refusal (ICMP)      8 and what it quotes, IPv6: 28
//   frame               what follows the Ethernet head, 46 at least, less IPv4's 20
//
// A datagram of more than a link carries (1500 bytes with its heads) leaves as fragments: each is
// a message of its own, with a send call's cost, and any may be lost. It arrives with the last of
// them; the hardware stamp is that of the first, as Linux has it. Fragments of a datagram that
// is not whole after 30 s (IPv6: 60 s) are forgotten.
//
// Source: RFC 768, 791, 792, 4443, 8200; IEEE 802.3; Linux, net/ipv4/ip_output.c, ip_fragment.c,
// icmp.c and their kin of IPv6.
//
//   const WirePacket packet{.head = {.to = shim::ipv4_address(0x0A000002, 123)},
//                           .payload = Bytes(5000)};
//   Reassembly reassembly;
//   for (const WirePacket& part : fragments_of(packet)) {  // four
//     const std::optional<WirePacket> whole = reassembly.add(0, part, SteadyTime{});
//     if (whole) use(whole->payload);  // with the fourth
//   }
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/ports/host.h"
#include "shim/protocol.h"

namespace simbench::sim {

enum class PacketKind : std::uint8_t { kDatagram, kRefusal, kFrame };

// What its heads say; a message has it behind the payload.
struct PacketHead {
  PacketKind kind = PacketKind::kDatagram;
  std::uint8_t hops = 64;
  std::uint8_t traffic_class = 0;
  std::uint8_t is_on_link = 0;  // 1: a frame for the other end of the sender's cable alone
  std::uint8_t reserved[4]{};
  std::uint32_t number = 0;  // of a datagram in fragments, among those of its host
  std::uint32_t begin = 0;   // of a fragment's payload in the datagram's
  std::uint32_t whole = 0;   // the datagram's payload; 0: it is no fragment
  shim::Address from{};
  shim::Address to{};
};

struct WirePacket {
  PacketHead head{};
  Bytes payload{};
  // The stamps of one that has arrived.
  std::int64_t system = shim::kNoStamp;
  std::int64_t hardware = shim::kNoStamp;
};

// The heads of Ethernet and UDP, and the least that a frame carries.
inline constexpr std::size_t kEthernetHead = 14;
inline constexpr std::size_t kUdpHead = 8;
inline constexpr std::size_t kLeastFramePayload = 46;

// The most that a datagram carries, and one that leaves in one packet.
std::size_t most_payload(bool is_ipv4);
std::size_t most_in_one_packet(bool is_ipv4, std::size_t mtu);
// What the first fragment of a datagram carries of its payload.
std::size_t most_in_first_fragment(bool is_ipv4);
// What a refusal quotes of a datagram's payload.
std::size_t most_quoted(bool is_ipv4);

double bytes_on_wire(const WirePacket& packet);
Bytes to_message(const WirePacket& packet);
// Nothing for what is no packet.
std::optional<WirePacket> packet_of(Bytes message);

// The packet itself if a link carries it.
std::vector<WirePacket> fragments_of(WirePacket packet);

// The datagrams of which some fragments have come to a host.
class Reassembly {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{4} << 20;  // more are not kept

  // The datagram, once it is whole; what is no fragment is.
  std::optional<WirePacket> add(PeerId from, WirePacket packet, SteadyTime now);

 private:
  struct Partial {
    WirePacket datagram{};
    std::map<std::uint32_t, std::uint32_t> parts{};  // the begin of each and its end
    SteadyTime begun{};
  };
  using Key = std::pair<PeerId, std::uint32_t>;

  void forget_old(SteadyTime now);

  std::map<Key, Partial> partial_;
  std::size_t bytes_ = 0;
};

}  // namespace simbench::sim
