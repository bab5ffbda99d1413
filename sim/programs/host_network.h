// UDP on the simulated network, as the programs of one host have it.
//
// Host i has the address 10.0.0.1 + i; a network has at most 65000 hosts. A datagram goes over the
// port's channel to its host (algorithms/ports/host.h), with its two ports behind the payload: four
// bytes on the wire beside the headers that the network counts anyway. It is delivered to the
// socket that is bound to its port, unless that is connected to another. Datagrams to the host
// itself arrive at once. There is no broadcast and no multicast: ENETUNREACH. Those that nobody
// waits for are dropped, and so is what comes when a socket holds kMostQueued.
//
// pump(peer) is the receiving half, a coroutine for each peer: wake-ups cost what the scenario says
// and stamps are taken where it says, as for any algorithm.
//
//   HostNetwork network(host, 6);
//   UdpSocket own;
//   network.bind(own, {.host = 0, .port = 123});
//   const int error = co_await network.send(own, {.host = network.address_of(0), .port = 123},
//                                           Bytes(48));
#ifndef SIMBENCH_SIM_PROGRAMS_HOST_NETWORK_H_
#define SIMBENCH_SIM_PROGRAMS_HOST_NETWORK_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "algorithms/ports/host.h"
#include "shim/protocol.h"

namespace simbench::sim {

struct QueuedDatagram {
  shim::Arrival arrival;
  Bytes payload;
};

struct UdpSocket {
  shim::Address local{};  // port 0: not bound
  std::optional<shim::Address> peer{};
  bool stamps_arrivals = false;
  bool stamps_departures = false;
  std::deque<QueuedDatagram> arrived{};
  std::deque<QueuedDatagram> departed{};  // the error queue: what has left, with its stamp
  std::function<void()> on_arrival{};
};

class HostNetwork {
 public:
  static constexpr std::uint32_t kFirstAddress = 0x0A000001;
  static constexpr std::size_t kMostQueued = 256;
  static constexpr std::size_t kMostPayload = 1472;  // one frame; fragments are not simulated

  // The host must outlive this.
  HostNetwork(Host& host, std::size_t hosts) : host_(host), hosts_(hosts) {}

  std::uint32_t address() const { return address_of(host_.id()); }
  static std::uint32_t address_of(PeerId host) { return kFirstAddress + host; }

  // These return an errno, or 0. A bound socket must be closed before it ends.
  int bind(UdpSocket& socket, shim::Address address);
  int connect(UdpSocket& socket, shim::Address peer);
  Task<int> send(UdpSocket& socket, shim::Address to, Bytes payload);
  void close(UdpSocket& socket);

  // Receives from a peer, for ever.
  Task<void> pump(PeerId peer);

 private:
  bool is_taken(std::uint16_t port, const UdpSocket* except) const;
  int bind_somewhere(UdpSocket& socket);
  void deliver(shim::Address from, shim::Address to, Bytes payload, std::optional<HostTime> stamp);

  Host& host_;
  std::size_t hosts_;
  std::vector<UdpSocket*> bound_;
  std::uint16_t next_port_ = 32'768;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_PROGRAMS_HOST_NETWORK_H_
