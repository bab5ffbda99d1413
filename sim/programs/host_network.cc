#include "sim/programs/host_network.h"

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cerrno>
#include <utility>

#include "sim/host/sim_channel.h"
#include "sim/programs/kernel_clock.h"

namespace simbench::sim {
namespace {

constexpr std::size_t kTrailerBytes = 8;
constexpr std::uint32_t kBroadcast = 0xFFFFFFFF;
constexpr std::uint32_t kNetBroadcast = processes::kFirstAddress | ~processes::kNetmask;

bool is_loopback(std::uint32_t address) { return address >> 24 == 127; }
bool is_multicast(std::uint32_t address) { return address >> 28 == 0xE; }

// The payload as it travels.
Bytes with_trailer(const QueuedDatagram& datagram) {
  Bytes message = datagram.payload;
  message.resize(message.size() + kTrailerBytes);
  auto* end = reinterpret_cast<unsigned char*>(message.data() + message.size() - kTrailerBytes);
  boost::endian::store_big_u32(end, datagram.arrival.to.host);
  boost::endian::store_big_u16(end + 4, datagram.arrival.from.port);
  boost::endian::store_big_u16(end + 6, datagram.arrival.to.port);
  return message;
}

std::int64_t stamp_ns(const std::optional<HostTime>& stamp) {
  return stamp ? epoch_ns(*stamp) : shim::kNoStamp;
}

std::int64_t stamp_ns(const std::optional<HardwareTime>& stamp) {
  return stamp ? nanoseconds_of(*stamp) + kEpochNs : shim::kNoStamp;
}

}  // namespace

HostNetwork::HostNetwork(SimHost& host, std::size_t hosts)
    : host_(host),
      hosts_(hosts),
      has_left_(host.world().context, host.name("programs' messages pass the card")),
      streams_(host, hosts) {
  host_.world().network.groups().join(Groups::kEveryone, host_.id());
}

bool HostNetwork::is_taken(shim::Address address, const UdpSocket& by) const {
  return std::ranges::any_of(bound_, [&](const UdpSocket* each) {
    const bool is_same_host =
        each->local.host == 0 || address.host == 0 || each->local.host == address.host;
    return each != &by && each->local.port == address.port && is_same_host &&
           !(each->shares_port && by.shares_port);
  });
}

int HostNetwork::bind(UdpSocket& socket, shim::Address address) {
  if (socket.local.port != 0) return EINVAL;
  const bool is_own = address.host == 0 || address.host == this->address() ||
                      is_loopback(address.host) || group_of(address.host);
  if (!is_own) return EADDRNOTAVAIL;
  if (address.port != 0 && is_taken(address, socket)) return EADDRINUSE;
  return bind_to(socket, address);
}

int HostNetwork::bind_to(UdpSocket& socket, shim::Address address) {
  const int error = address.port == 0 ? ports_.give(address, bound_) : 0;
  if (error != 0) return error;
  socket.local = address;
  socket.number = ++sockets_bound_;
  bound_.push_back(&socket);
  return 0;
}

int HostNetwork::connect(UdpSocket& socket, shim::Address peer) {
  if (group_of(peer.host) == Groups::kEveryone && !socket.may_broadcast) return EACCES;
  if (socket.local.port == 0) {
    const int error = bind_to(socket, socket.local);
    if (error != 0) return error;
  }
  socket.peer = peer;
  if (socket.local.host == 0) socket.local.host = is_loopback(peer.host) ? peer.host : address();
  return 0;
}

int HostNetwork::join(UdpSocket& socket, std::uint32_t group) {
  if (!is_multicast(group)) return EINVAL;
  if (socket.groups.contains(group)) return EADDRINUSE;
  if (socket.groups.size() == kMostGroups) return ENOBUFS;
  socket.groups.insert(group);
  if (++joined_[group] == 1) host_.world().network.groups().join(group, host_.id());
  return 0;
}

int HostNetwork::leave(UdpSocket& socket, std::uint32_t group) {
  if (socket.groups.erase(group) == 0) return EADDRNOTAVAIL;
  if (--joined_[group] == 0) host_.world().network.groups().leave(group, host_.id());
  return 0;
}

void HostNetwork::close(UdpSocket& socket) {
  while (!socket.groups.empty()) leave(socket, *socket.groups.begin());
  std::erase(bound_, &socket);
}

std::optional<std::uint32_t> HostNetwork::group_of(std::uint32_t address) {
  if (is_multicast(address)) return address;
  if (address == kBroadcast || address == kNetBroadcast) return Groups::kEveryone;
  return std::nullopt;
}

Task<int> HostNetwork::send(UdpSocket& socket, shim::Address to, Bytes payload, unsigned stamps) {
  if (to.port == 0) {
    if (!socket.peer) co_return EDESTADDRREQ;
    to = *socket.peer;
  }
  const std::optional<std::uint32_t> group = group_of(to.host);
  if (group == Groups::kEveryone && !socket.may_broadcast) co_return EACCES;
  if (socket.local.port == 0) {
    const int error = bind_to(socket, socket.local);
    if (error != 0) co_return error;
  }
  if (payload.size() > kMostPayload) co_return EMSGSIZE;
  const bool is_inward = is_loopback(to.host);
  const auto length = static_cast<std::uint32_t>(payload.size());
  Leaving leaving{.socket = socket.number,
                  .stamps = stamps,
                  .datagram = {.arrival = {.from = {.host = is_inward ? to.host : address(),
                                                    .port = socket.local.port,
                                                    .reserved = 0},
                                           .to = to,
                                           .system = shim::kNoStamp,
                                           .hardware = shim::kNoStamp,
                                           .length = length,
                                           .number = socket.sent++},
                               .payload = std::move(payload)}};
  if (is_inward || to.host == address()) {
    deliver(leaving.datagram);
    co_return 0;
  }
  if (group) {
    co_await send_to_group(socket, *group, std::move(leaving));
    co_return 0;
  }
  if (to.host < processes::kFirstAddress || to.host - processes::kFirstAddress >= hosts_)
    co_return ENETUNREACH;
  leaving.peer = to.host - processes::kFirstAddress;
  co_await send_to_peer(socket, std::move(leaving));
  co_return 0;
}

Task<void> HostNetwork::send_to_peer(UdpSocket& socket, Leaving leaving) {
  SimChannel& channel = host_.datagram_channel(*leaving.peer);
  leaving.message = co_await channel.send(with_trailer(leaving.datagram));
  if (leaving.stamps == 0) co_return;
  const std::optional<HostTime> left =
      co_await channel.transmit_stamp(leaving.message, host_.steady_clock().now());
  keep_stamps(socket, left, std::move(leaving));
}

Task<void> HostNetwork::send_to_group(UdpSocket& socket, std::uint32_t group, Leaving leaving) {
  SimMulticast& multicast = host_.multicast();
  leaving.message = co_await multicast.send(group, with_trailer(leaving.datagram));
  if (socket.hears_itself) deliver_to_all(leaving.datagram);
  if (leaving.stamps == 0) co_return;
  const std::optional<HostTime> left =
      co_await multicast.stamp(leaving.message, host_.steady_clock().now());
  keep_stamps(socket, left, std::move(leaving));
}

void HostNetwork::keep_stamps(UdpSocket& socket, std::optional<HostTime> left, Leaving leaving) {
  const unsigned wanted = leaving.stamps;
  const bool by_card =
      (wanted & shim::kHardwareStamps) != 0 && card_stamping_.departures && host_.nic() != nullptr;
  // As Linux, which takes both only where both are asked for.
  const bool by_software =
      (wanted & shim::kSoftwareStamps) != 0 && (!by_card || (wanted & shim::kBothStamps) != 0);
  if (by_software && left) {
    QueuedDatagram stamped = leaving.datagram;
    stamped.arrival.system = stamp_ns(left);
    queue_departure(socket, std::move(stamped));
  }
  if (!by_card) return;
  leaving_.push_back(std::move(leaving));
  has_left_.notify();
}

void HostNetwork::queue_departure(UdpSocket& socket, QueuedDatagram datagram) {
  if (socket.departed.size() == kMostQueued) return;
  socket.departed.push_back(std::move(datagram));
  socket.on_arrival();
}

Task<void> HostNetwork::stamp_departures() {
  for (;;) {
    while (leaving_.empty()) co_await has_left_.wait();
    Leaving leaving = std::move(leaving_.front());
    leaving_.pop_front();
    const SteadyTime deadline = host_.steady_clock().now() + kStampTimeout;
    std::optional<HardwareTime> stamp;
    if (leaving.peer) {
      stamp = co_await host_.datagram_channel(*leaving.peer)
                  .hardware_transmit_stamp(leaving.message, deadline);
    } else {
      stamp = co_await host_.multicast().hardware_stamp(leaving.message, deadline);
    }
    const auto found = std::ranges::find_if(
        bound_, [&](const UdpSocket* each) { return each->number == leaving.socket; });
    if (!stamp || found == bound_.end()) continue;
    leaving.datagram.arrival.hardware = stamp_ns(stamp);
    queue_departure(**found, std::move(leaving.datagram));
  }
}

Task<void> HostNetwork::pump(PeerId peer) {
  SimChannel& channel = host_.datagram_channel(peer);
  for (;;) {
    std::optional<ReceivedMessage> message =
        co_await channel.receive(host_.steady_clock().now() + kIdle);
    if (!message || message->bytes.size() < kTrailerBytes) continue;
    Bytes& bytes = message->bytes;
    const std::size_t length = bytes.size() - kTrailerBytes;
    const auto* trailer = reinterpret_cast<const unsigned char*>(bytes.data() + length);
    const shim::Address to{.host = boost::endian::load_big_u32(trailer),
                           .port = boost::endian::load_big_u16(trailer + 6),
                           .reserved = 0};
    const shim::Address from{.host = processes::address_of(peer),
                             .port = boost::endian::load_big_u16(trailer + 4),
                             .reserved = 0};
    bytes.resize(length);
    std::optional<HardwareTime> by_card;
    if (card_stamping_.arrivals) by_card = message->received_hardware;
    const QueuedDatagram datagram{.arrival = {.from = from,
                                              .to = to,
                                              .system = stamp_ns(message->received),
                                              .hardware = stamp_ns(by_card),
                                              .length = static_cast<std::uint32_t>(length),
                                              .number = 0},
                                  .payload = std::move(bytes)};
    if (group_of(to.host)) {
      deliver_to_all(datagram);
    } else {
      deliver(datagram);
    }
  }
}

namespace {

bool is_for(const UdpSocket& socket, const shim::Arrival& arrival) {
  return socket.local.port == arrival.to.port &&
         (socket.local.host == 0 || socket.local.host == arrival.to.host) &&
         (!socket.peer ||
          (socket.peer->host == arrival.from.host && socket.peer->port == arrival.from.port));
}

}  // namespace

void HostNetwork::deliver(const QueuedDatagram& datagram) {
  UdpSocket* best = nullptr;
  const auto states = [](const UdpSocket& socket) {
    return (socket.peer ? 2 : 0) + (socket.local.host != 0 ? 1 : 0);
  };
  for (UdpSocket* each : bound_) {
    if (!is_for(*each, datagram.arrival)) continue;
    if (best == nullptr || states(*each) >= states(*best)) best = each;
  }
  if (best != nullptr) queue_arrival(*best, datagram);
}

void HostNetwork::deliver_to_all(const QueuedDatagram& datagram) {
  const std::uint32_t group = datagram.arrival.to.host;
  for (UdpSocket* each : bound_) {
    if (!is_for(*each, datagram.arrival)) continue;
    const bool takes = !is_multicast(group) || each->groups.contains(group) ||
                       (each->takes_all_groups && joined_[group] > 0);
    if (takes) queue_arrival(*each, datagram);
  }
}

void HostNetwork::queue_arrival(UdpSocket& socket, QueuedDatagram datagram) {
  if (socket.arrived.size() == kMostQueued) return;
  shim::Arrival& arrival = datagram.arrival;
  if ((socket.arrival_stamps & shim::kSoftwareStamps) == 0) arrival.system = shim::kNoStamp;
  if ((socket.arrival_stamps & shim::kHardwareStamps) == 0) arrival.hardware = shim::kNoStamp;
  socket.arrived.push_back(std::move(datagram));
  socket.on_arrival();
}

}  // namespace simbench::sim
