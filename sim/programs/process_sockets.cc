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

Process::Answer Process::open_socket(const ChildRequest& request) {
  if (open_.size() >= kMostOpen) return {.error = EMFILE};
  const int fd = request.head.fd;
  const auto family = static_cast<int>(request.head.b & 0xFFFF);
  if (family != AF_INET && family != AF_INET6 && family != AF_PACKET) {
    return {.error = EAFNOSUPPORT};
  }
  if (request.head.a == SOCK_STREAM && family == AF_PACKET) return {.error = ESOCKTNOSUPPORT};
  if (request.head.a == SOCK_STREAM) return open_stream(fd, family);
  const std::shared_ptr<OpenObject> object = open(fd, UdpSocket{.family = family});
  UdpSocket& socket = *object->socket();
  if (family == AF_PACKET) {
    socket.packet = PacketPart{.has_link_heads = request.head.a == SOCK_RAW,
                               .protocol = static_cast<std::uint16_t>(request.head.b >> 16)};
  }
  socket.on_arrival = [wake = around_.wake, object = object.get()] {
    object->changed(POLLIN | POLLOUT | POLLERR | POLLPRI | POLLHUP | POLLRDHUP);
    wake();
  };
  around_.network.open(socket);
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
      if (!socket.peer) return {.error = socket.packet ? EOPNOTSUPP : ENOTCONN};
      return {.data = bytes_of(*socket.peer)};
    case Call::kReceive:
      return receive(socket, request.head.a);
    case Call::kListen:
    case Call::kAccept:
      return {.error = EOPNOTSUPP};
    case Call::kShutDown:
      return {.error = around_.network.shut_down(socket, static_cast<int>(request.head.a))};
    case Call::kSocketError:
      return {.value = take_error(socket)};
    case Call::kCountInput:
      return {.value = socket.arrived.empty()
                           ? 0
                           : static_cast<std::int64_t>(socket.arrived.front().payload.size())};
    case Call::kJoin:
      return {.error = around_.network.join(socket, request.head.a != 0,
                                            static_cast<int>(request.head.b),
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
  const int error = co_await around_.network.send(socket, departure, std::move(payload), stamps);
  co_return Answer{.error = error};
}

}  // namespace simbench::sim
