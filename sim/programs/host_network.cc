#include "sim/programs/host_network.h"

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cerrno>
#include <utility>

#include "sim/programs/kernel_clock.h"

namespace simbench::sim {
namespace {

constexpr std::uint32_t kLoopback = 0x7F000001;
constexpr std::size_t kPortBytes = 4;
constexpr std::uint16_t kFirstFreePort = 32'768;
constexpr std::uint16_t kLastFreePort = 60'999;

void append_ports(Bytes& payload, std::uint16_t from, std::uint16_t to) {
  payload.resize(payload.size() + kPortBytes);
  auto* end = reinterpret_cast<unsigned char*>(payload.data() + payload.size() - kPortBytes);
  boost::endian::store_big_u16(end, from);
  boost::endian::store_big_u16(end + 2, to);
}

}  // namespace

bool HostNetwork::is_taken(std::uint16_t port, const UdpSocket* except) const {
  return std::ranges::any_of(bound_, [port, except](const UdpSocket* each) {
    return each != except && each->local.port == port;
  });
}

int HostNetwork::bind(UdpSocket& socket, shim::Address address) {
  if (socket.local.port != 0) return EINVAL;
  const bool is_own =
      address.host == 0 || address.host == this->address() || address.host == kLoopback;
  if (!is_own) return EADDRNOTAVAIL;
  if (address.port == 0) {
    socket.local.host = address.host;
    return bind_somewhere(socket);
  }
  if (is_taken(address.port, &socket)) return EADDRINUSE;
  socket.local = address;
  bound_.push_back(&socket);
  return 0;
}

int HostNetwork::bind_somewhere(UdpSocket& socket) {
  for (int tried = 0; tried <= kLastFreePort - kFirstFreePort; ++tried) {
    const std::uint16_t port = next_port_;
    next_port_ = port == kLastFreePort ? kFirstFreePort : static_cast<std::uint16_t>(port + 1);
    if (is_taken(port, &socket)) continue;
    socket.local.port = port;
    bound_.push_back(&socket);
    return 0;
  }
  return EADDRINUSE;
}

int HostNetwork::connect(UdpSocket& socket, shim::Address peer) {
  if (socket.local.port == 0) {
    const int error = bind_somewhere(socket);
    if (error != 0) return error;
  }
  socket.peer = peer;
  if (socket.local.host == 0) socket.local.host = address();
  return 0;
}

void HostNetwork::close(UdpSocket& socket) { std::erase(bound_, &socket); }

Task<int> HostNetwork::send(UdpSocket& socket, shim::Address to, Bytes payload) {
  if (to.port == 0) {
    if (!socket.peer) co_return EDESTADDRREQ;
    to = *socket.peer;
  }
  if (socket.local.port == 0) {
    const int error = bind_somewhere(socket);
    if (error != 0) co_return error;
  }
  if (payload.size() > kMostPayload) co_return EMSGSIZE;
  const shim::Address from{.host = address(), .port = socket.local.port, .reserved = 0};
  if (to.host == address() || to.host == kLoopback) {
    deliver(from, to, std::move(payload), std::nullopt);
    co_return 0;
  }
  if (to.host < kFirstAddress || to.host - kFirstAddress >= hosts_) co_return ENETUNREACH;
  const PeerId peer = to.host - kFirstAddress;
  MessageChannel& channel = host_.open_channel(peer, Transport::kDatagram);
  Bytes message = payload;
  append_ports(message, from.port, to.port);
  const MessageId id = co_await channel.send(std::move(message));
  if (!socket.stamps_departures) co_return 0;
  const std::optional<HostTime> left =
      co_await channel.transmit_stamp(id, host_.steady_clock().now());
  if (!left || socket.departed.size() == kMostQueued) co_return 0;
  const auto length = static_cast<std::uint32_t>(payload.size());
  socket.departed.push_back(
      {.arrival =
           {.from = from, .to = to, .system = epoch_ns(*left), .length = length, .reserved = 0},
       .payload = std::move(payload)});
  co_return 0;
}

Task<void> HostNetwork::pump(PeerId peer) {
  MessageChannel& channel = host_.open_channel(peer, Transport::kDatagram);
  for (;;) {
    std::optional<ReceivedMessage> message =
        co_await channel.receive(host_.steady_clock().now() + kIdle);
    if (!message || message->bytes.size() < kPortBytes) continue;
    Bytes& bytes = message->bytes;
    const auto* ports =
        reinterpret_cast<const unsigned char*>(bytes.data() + bytes.size() - kPortBytes);
    const shim::Address from{
        .host = address_of(peer), .port = boost::endian::load_big_u16(ports), .reserved = 0};
    const shim::Address to{
        .host = address(), .port = boost::endian::load_big_u16(ports + 2), .reserved = 0};
    bytes.resize(bytes.size() - kPortBytes);
    deliver(from, to, std::move(bytes), message->received);
  }
}

void HostNetwork::deliver(shim::Address from, shim::Address to, Bytes payload,
                          std::optional<HostTime> stamp) {
  const auto wants = [&from, &to](const UdpSocket* each) {
    return each->local.port == to.port &&
           (!each->peer || (each->peer->host == from.host && each->peer->port == from.port));
  };
  const auto found = std::ranges::find_if(bound_, wants);
  if (found == bound_.end() || (*found)->arrived.size() == kMostQueued) return;
  UdpSocket& socket = **found;
  const bool is_stamped = stamp && socket.stamps_arrivals;
  const auto length = static_cast<std::uint32_t>(payload.size());
  socket.arrived.push_back({.arrival = {.from = from,
                                        .to = to,
                                        .system = is_stamped ? epoch_ns(*stamp) : shim::kNoStamp,
                                        .length = length,
                                        .reserved = 0},
                            .payload = std::move(payload)});
  socket.on_arrival();
}

}  // namespace simbench::sim
