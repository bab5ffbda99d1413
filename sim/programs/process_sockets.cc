// The requests that concern sockets.
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <utility>
#include <vector>

#include "sim/programs/process.h"

namespace simbench::sim {

using shim::Call;

std::shared_ptr<OpenObject> Process::object_of(int fd) const {
  const auto found = open_.find(fd);
  return found != open_.end() ? found->second : nullptr;
}

// One that was left open under this number ends.
std::shared_ptr<OpenObject> Process::open(int fd, OpenObject::What what) {
  auto object = std::make_shared<OpenObject>(std::move(what));
  std::swap(open_[fd], object);
  if (object != nullptr && object.use_count() == 1 && object->socket() != nullptr) {
    around_.network.close(*object->socket());
  }
  return open_[fd];
}

UdpSocket& Process::socket_of(int fd) {
  const std::shared_ptr<OpenObject> object = object_of(fd);
  if (object == nullptr || object->socket() == nullptr) {
    throw BadRequest("used a socket that it never opened");
  }
  return *object->socket();
}

Process::Answer Process::open_socket(int fd, std::int64_t type) {
  if (open_.size() >= kMostOpen) return {.error = EMFILE};
  if (type == SOCK_STREAM) return open_stream(fd);
  const std::shared_ptr<OpenObject> object = open(fd, UdpSocket{});
  object->socket()->on_arrival = [wake = around_.wake, object = object.get()] {
    object->changed(POLLIN | POLLERR | POLLPRI);
    wake();
  };
  return {};
}

// The object ends with its last descriptor, in whichever process.
Task<Process::Answer> Process::close(int fd) {
  const auto found = open_.find(fd);
  if (found == open_.end()) co_return Answer{};
  const std::shared_ptr<OpenObject> object = std::move(found->second);
  open_.erase(found);
  if (object.use_count() > 1) co_return Answer{};
  if (UdpSocket* socket = object->socket()) around_.network.close(*socket);
  if (const std::shared_ptr<StreamSocket> stream = object->stream_pointer()) {
    co_await around_.network.streams().close(stream);
  }
  co_return Answer{};
}

Task<void> Process::close_all() {
  while (!open_.empty()) co_await close(open_.begin()->first);
}

Task<void> Process::keep_only(const Bytes& numbers) {
  std::set<std::int32_t> kept;
  for (std::size_t i = 0; i + sizeof(std::int32_t) <= numbers.size(); i += sizeof(std::int32_t)) {
    std::int32_t number = 0;
    std::memcpy(&number, numbers.data() + i, sizeof number);
    kept.insert(number);
  }
  std::vector<int> closed;
  for (const auto& [number, object] : open_) {
    if (!kept.contains(number)) closed.push_back(number);
  }
  for (const int each : closed) co_await close(each);
  // As exec() has it: alarms go on, timers of timer_create() do not.
  std::erase_if(signal_timers_, [](const auto& timer) { return timer.first != -1; });
}

Process::Answer Process::of_socket(const ChildRequest& request) {
  UdpSocket& socket = socket_of(request.head.fd);
  switch (request.head.call) {
    case Call::kBind:
      return {.error = around_.network.bind(socket, read_head<shim::Address>(request.data))};
    case Call::kConnect:
      return {.error = around_.network.connect(socket, read_head<shim::Address>(request.data))};
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
  return joins ? around_.network.join(socket, address) : around_.network.leave(socket, address);
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
  const int error = co_await around_.network.send(socket, to, std::move(payload), stamps);
  co_return Answer{.error = error};
}

}  // namespace simbench::sim
