// The requests that concern sockets.
#include <sys/socket.h>

#include <cerrno>
#include <utility>

#include "sim/programs/process.h"

namespace simbench::sim {

using shim::Call;

UdpSocket& Process::socket_of(int fd) {
  const auto found = sockets_.find(fd);
  if (found == sockets_.end()) throw BadRequest("used a socket that it never opened");
  return found->second;
}

Process::Answer Process::open_socket(int fd, std::int64_t type) {
  if (open_descriptors() >= kMostOpen) return {.error = EMFILE};
  if (type == SOCK_STREAM) return open_stream(fd);
  UdpSocket& socket = sockets_[fd];
  network_.close(socket);  // one that was left open under this number
  socket = {};
  socket.on_arrival = [this] { woken_.notify(); };
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
      if (!socket.peer) return {.error = ENOTCONN};
      return {.data = bytes_of(*socket.peer)};
    case Call::kReceive:
      return receive(socket, request.head.a);
    case Call::kListen:
    case Call::kAccept:
      return {.error = EOPNOTSUPP};
    case Call::kShutDown:
      return {.error = socket.peer ? 0 : ENOTCONN};
    case Call::kSocketError:
      return {};
    case Call::kCountInput:
      return {.value = socket.arrived.empty()
                           ? 0
                           : static_cast<std::int64_t>(socket.arrived.front().payload.size())};
    case Call::kJoin:
      return {.error = join(socket, request.head.a != 0, request.head.b)};
    default:
      return set_option(socket, static_cast<shim::SocketOption>(request.head.a), request.head.b);
  }
}

int Process::join(UdpSocket& socket, bool joins, std::int64_t group) {
  const auto address = static_cast<std::uint32_t>(group);
  return joins ? network_.join(socket, address) : network_.leave(socket, address);
}

Process::Answer Process::set_option(UdpSocket& socket, shim::SocketOption option,
                                    std::int64_t value) {
  const bool is_on = value != 0;
  switch (option) {
    case shim::SocketOption::kReceiveStamps:
      socket.arrival_stamps = static_cast<unsigned>(value);
      return {};
    case shim::SocketOption::kTransmitStamps:
      socket.departure_stamps = static_cast<unsigned>(value);
      return {.value = socket.sent};
    case shim::SocketOption::kReuseAddress:
      socket.shares_port = is_on;
      return {};
    case shim::SocketOption::kBroadcast:
      socket.may_broadcast = is_on;
      return {};
    case shim::SocketOption::kUrgentErrors:
      socket.has_urgent_errors = is_on;
      return {};
    case shim::SocketOption::kAllGroups:
      socket.takes_all_groups = is_on;
      return {};
    case shim::SocketOption::kLoopGroups:
      socket.hears_itself = is_on;
      return {};
  }
  return {.error = ENOPROTOOPT};
}

Process::Answer Process::receive(UdpSocket& socket, std::int64_t how) {
  std::deque<QueuedDatagram>& queue = (how & 1) != 0 ? socket.departed : socket.arrived;
  if (queue.empty()) return {.error = EAGAIN};
  Answer answer{.data = bytes_of(queue.front().arrival)};
  const Bytes& payload = queue.front().payload;
  answer.data.insert(answer.data.end(), payload.begin(), payload.end());
  if ((how & 2) == 0) queue.pop_front();
  return answer;
}

Task<Process::Answer> Process::send(ChildRequest request) {
  UdpSocket& socket = socket_of(request.head.fd);
  const auto to = read_head<shim::Address>(request.data);
  Bytes payload(request.data.begin() + sizeof to, request.data.end());
  const std::int64_t asked = request.head.a;
  const unsigned stamps = asked < 0 ? socket.departure_stamps : static_cast<unsigned>(asked);
  const int error = co_await network_.send(socket, to, std::move(payload), stamps);
  co_return Answer{.error = error};
}

}  // namespace simbench::sim
