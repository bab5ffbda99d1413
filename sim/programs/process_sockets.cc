// The requests that concern sockets.
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "sim/programs/process.h"

namespace simbench::sim {

using shim::Call;

UdpSocket& Process::socket_of(int fd) {
  const auto found = sockets_.find(fd);
  if (found == sockets_.end()) throw BadRequest("used a socket that it never opened");
  return found->second;
}

Process::Answer Process::open_socket(const ChildRequest& request) {
  if (open_descriptors() >= kMostOpen) return {.error = EMFILE};
  const int fd = request.head.fd;
  const auto family = static_cast<int>(request.head.b & 0xFFFF);
  if (family != AF_INET && family != AF_INET6 && family != AF_PACKET) {
    return {.error = EAFNOSUPPORT};
  }
  if (request.head.a == SOCK_STREAM && family == AF_PACKET) return {.error = ESOCKTNOSUPPORT};
  if (request.head.a == SOCK_STREAM) return open_stream(fd, family);
  UdpSocket& socket = sockets_[fd];
  network_.close(socket);  // one that was left open under this number
  socket = {};
  socket.family = family;
  if (family == AF_PACKET) {
    socket.packet = PacketPart{.has_link_heads = request.head.a == SOCK_RAW,
                               .protocol = static_cast<std::uint16_t>(request.head.b >> 16)};
  }
  socket.on_arrival = [this] { woken_.notify(); };
  network_.open(socket);
  return {};
}

Process::Answer Process::close(int fd) {
  if (const auto found = sockets_.find(fd); found != sockets_.end()) {
    network_.close(found->second);
    sockets_.erase(found);
  }
  timers_.erase(fd);
  return {};
}

void Process::close_sockets() {
  for (auto& [fd, socket] : sockets_) network_.close(socket);
  sockets_.clear();
}

Process::Answer Process::of_socket(const ChildRequest& request) {
  UdpSocket& socket = socket_of(request.head.fd);
  switch (request.head.call) {
    case Call::kBind:
      return {.error = network_.bind(socket, read_head<shim::Address>(request.data))};
    case Call::kConnect:
      return {.error = network_.connect(socket, read_head<shim::Address>(request.data))};
    case Call::kName:
      return {.data = bytes_of(socket.local)};
    case Call::kPeerName:
      if (!socket.peer) return {.error = socket.packet ? EOPNOTSUPP : ENOTCONN};
      return {.data = bytes_of(*socket.peer)};
    case Call::kReceive:
      return receive(socket, request.head.a);
    case Call::kListen:
    case Call::kAccept:
      return {.error = EOPNOTSUPP};
    case Call::kShutDown:
      return {.error = network_.shut_down(socket, static_cast<int>(request.head.a))};
    case Call::kSocketError:
      return {.value = take_error(socket)};
    case Call::kCountInput:
      return {.value = socket.arrived.empty()
                           ? 0
                           : static_cast<std::int64_t>(socket.arrived.front().payload.size())};
    case Call::kJoin:
      return {.error = network_.join(socket, request.head.a != 0, static_cast<int>(request.head.b),
                                     read_head<shim::Address>(request.data))};
    case Call::kFilterArrivals:
      return {.error = set_filter(socket, request.data)};
    case Call::kCountArrivals:
      if (!socket.packet) return {.error = ENOPROTOOPT};
      return {.data = bytes_of(std::exchange(socket.packet->counted, {}))};
    default:
      return {.value = socket.sent,
              .error = set_socket_option(socket, request.head.a, request.head.b)};
  }
}

int Process::set_filter(UdpSocket& socket, const Bytes& data) {
  std::vector<sock_filter> code(data.size() / sizeof(sock_filter));
  if (code.empty()) {
    if (!socket.filter.is_set()) return ENOENT;
    socket.filter = {};
    return 0;
  }
  std::memcpy(code.data(), data.data(), code.size() * sizeof code[0]);
  const int error = PacketFilter::check(code);
  if (error == 0) socket.filter = PacketFilter(std::move(code));
  return error;
}

Process::Answer Process::receive(UdpSocket& socket, std::int64_t how) {
  const TakenDatagram taken = take_datagram(socket, how);
  if (taken.error != 0) return {.error = taken.error};
  Answer answer{.data = bytes_of(taken.datagram.arrival)};
  const Bytes& payload = taken.datagram.payload;
  answer.data.insert(answer.data.end(), payload.begin(), payload.end());
  return answer;
}

Task<Process::Answer> Process::send(ChildRequest request) {
  UdpSocket& socket = socket_of(request.head.fd);
  const auto departure = read_head<shim::Departure>(request.data);
  Bytes payload(request.data.begin() + sizeof departure, request.data.end());
  const std::int64_t asked = request.head.a;
  const unsigned stamps = asked < 0 ? socket.departure_stamps : static_cast<unsigned>(asked);
  const int error = co_await network_.send(socket, departure, std::move(payload), stamps);
  co_return Answer{.error = error};
}

}  // namespace simbench::sim
