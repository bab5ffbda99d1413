// How the packets of a host's programs leave, and what their sockets hear of it.
//
// A packet is one message of the host's datagram channel to another (algorithms/ports/host.h), or
// one to a group (sim/host/sim_channel.h), and costs a send call. Its stamps go to the error queue
// of its socket: that by software when the call returns, or once the host's own queue has let the
// message go, that of the card as the message passes it, if the card stamps departures
// (SIOCSHWTSTAMP). A datagram in fragments has the stamp of the first, as Linux does.
//
// Sockets are known by numbers, so that one that is closed meanwhile hears nothing.
//
//   PacketSender sender(host);
//   UdpSocket own;
//   sender.enrol(own);
//   co_await sender.send(own.number, {.peer = 3}, WirePacket{}, shim::kSoftwareStamps, {});
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "algorithms/ports/host.h"
#include "sim/engine/virtual_executor.h"
#include "sim/host/sim_host.h"
#include "sim/network/groups.h"
#include "sim/programs/packet.h"
#include "sim/programs/udp_socket.h"

namespace simbench::sim {

// What the card stamps.
struct CardStamping {
  bool arrivals = false;
  bool departures = false;
};

class PacketSender {
 public:
  // A host, or a group of them.
  struct Way {
    std::optional<PeerId> peer{};
    Groups::Id group = 0;
  };

  // The host must outlive this.
  explicit PacketSender(SimHost& host);

  // From now on the socket has a number, until it is dismissed. It must be before it ends.
  void enrol(UdpSocket& socket);
  void dismiss(UdpSocket& socket);
  // Null if it has been dismissed.
  UdpSocket* find(std::uint64_t socket) const;

  // What the card stamps, for all sockets of the host; nothing at first.
  CardStamping card_stamping() const { return card_stamping_; }
  void set_card_stamping(CardStamping stamping) { card_stamping_ = stamping; }

  // In fragments, if it is large. `stamps` are those of this departure, shim::StampKind as bits;
  // `told` is what its socket then hears.
  Task<void> send(std::uint64_t socket, Way way, WirePacket packet, unsigned stamps,
                  QueuedDatagram told);
  // For what takes the loopback, which stamps by software.
  void stamp_at_once(UdpSocket& socket, unsigned stamps, QueuedDatagram told);
  // The kernel's stamp of what happens now; kNoStamp where stamps are the programs' own.
  std::int64_t stamp_now() const;

  // Stamps what leaves, for ever.
  Task<void> stamp_departures();

 private:
  // A message on its way to the card, and what its stamps wait for.
  struct Leaving {
    std::uint64_t socket = 0;
    Way way{};
    MessageId message = 0;
    bool lacks_software = false;
    bool lacks_hardware = false;
    QueuedDatagram told{};
  };

  Task<MessageId> send_part(const Way& way, const WirePacket& part);
  Task<std::optional<HostTime>> software_stamp(const Leaving& leaving, SteadyTime deadline);
  Task<std::optional<HardwareTime>> hardware_stamp(const Leaving& leaving, SteadyTime deadline);
  void tell(std::uint64_t socket, QueuedDatagram told, std::int64_t system, std::int64_t hardware);

  SimHost& host_;
  std::map<std::uint64_t, UdpSocket*> sockets_;
  std::uint64_t enrolled_ = 0;
  CardStamping card_stamping_{};
  std::deque<Leaving> leaving_;
  WaitPoint has_left_;
};

// As the programs count: from 1970 on.
std::int64_t stamp_of(const std::optional<HostTime>& stamp);
std::int64_t stamp_of(const std::optional<HardwareTime>& stamp);

}  // namespace simbench::sim
