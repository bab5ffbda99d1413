// Packet sockets of one host: Ethernet frames between programs, as PTP sends them over layer 2.
//
//  - A frame for a card goes to its host; one for a group, or for a card that nobody has, to every
//    host, as a switch floods what is not IP. A card takes its own address, broadcasts, and the
//    groups that a socket of its host has joined (PACKET_ADD_MEMBERSHIP), all groups or everything.
//  - 01:80:C2:00:00:00 to 0F is for the other end of the cable alone, as no bridge forwards it
//    (IEEE 802.1Q, 8.6.3): gPTP, and PTP's peer delays. A switch that knows no PTP drops such
//    frames, so that gPTP finds nobody; sim/programs/cables.h has where they lead elsewhere. Cards
//    but for eth0 carry frames to their neighbour alone.
//
// A socket for all protocols (ETH_P_ALL) sees what the host's other packet sockets send, too.
// Frames come padded to 60 bytes. Not simulated: frames of IP, which packet sockets do not see and
// cannot send to IP sockets; fan-outs, rings, virtual LANs but as bytes. All cards share the one
// port of the host, its queue and its clock.
//
// Calls return an errno, or 0. A socket that is opened must be closed before it ends.
//
// Source: packet(7); IEEE 802.3, 802.1Q; Linux, net/packet/af_packet.c.
//
//   PacketSender sender(host);
//   HostFrames frames(host, sender, 6);
//   UdpSocket own{.family = AF_PACKET, .packet = PacketPart{.protocol = 0x88F7}};
//   frames.open(own);
//   const int error = co_await frames.send(own, {}, Bytes(60), 0);  // ENXIO: by no interface
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithms/ports/host.h"
#include "shim/protocol.h"
#include "sim/host/sim_host.h"
#include "sim/programs/cables.h"
#include "sim/programs/packet.h"
#include "sim/programs/packet_sender.h"
#include "sim/programs/udp_socket.h"

namespace simbench::sim {

class HostFrames {
 public:
  // The host and the sender must outlive this.
  HostFrames(SimHost& host, PacketSender& sender, std::size_t hosts);

  const Cables& cables() const { return cables_; }

  void open(UdpSocket& socket);
  void close(UdpSocket& socket);
  int bind(UdpSocket& socket, const shim::Address& address);
  // `kind`: PACKET_MR_...; the scope of the group is its interface.
  int join(UdpSocket& socket, bool joins, int kind, const shim::Address& group);
  // `to` may have no family: the interface to which it is bound.
  Task<int> send(UdpSocket& socket, shim::Address to, Bytes data, unsigned stamps);
  // A frame that came from a host.
  void take(PeerId from, WirePacket frame);

 private:
  using CardAddress = std::array<std::uint8_t, 6>;
  // A frame as the sockets see it.
  struct Seen {
    std::uint32_t interface = 0;
    std::uint16_t protocol = 0;
    std::uint8_t kind = 0;  // PACKET_HOST, ...
    CardAddress from{};
    Bytes frame{};
    std::int64_t system = shim::kNoStamp;
    std::int64_t hardware = shim::kNoStamp;
  };

  bool is_interface(std::uint32_t number) const;
  CardAddress card_address(std::uint32_t interface) const;
  // The host that has the address, on its first card.
  std::optional<PeerId> owner_of(const CardAddress& address) const;
  PacketSender::Way way_of(std::uint32_t card, const CardAddress& to) const;
  bool takes(std::uint32_t interface, std::uint8_t kind, const CardAddress& to) const;
  std::uint8_t kind_of(std::uint32_t interface, const CardAddress& to) const;
  void deliver(const Seen& seen, const UdpSocket* sender);
  static QueuedDatagram queued(const Seen& seen);
  // The whole frame, or an errno.
  int build_frame(const UdpSocket& socket, std::uint32_t interface, const shim::Address& to,
                  Bytes data, Seen& seen) const;

  SimHost& host_;
  PacketSender& sender_;
  std::size_t hosts_;
  std::uint32_t ipv4_;
  Cables cables_;
  std::vector<UdpSocket*> sockets_;
};

}  // namespace simbench::sim
