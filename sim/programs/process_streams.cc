// The requests that concern connections.
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <span>
#include <utility>

#include "sim/programs/process.h"

namespace simbench::sim {

using shim::Call;

bool Process::is_of_stream(const ChildRequest& request) const {
  if (request.head.call == Call::kWait || request.head.call == Call::kClose) return false;
  const std::shared_ptr<OpenObject> object = object_of(request.head.fd);
  return object != nullptr && object->stream() != nullptr;
}

std::shared_ptr<OpenObject> Process::add_stream(int fd, std::shared_ptr<StreamSocket> stream) {
  std::shared_ptr<OpenObject> object = open(fd, stream);
  stream->on_change = [wake = around_.wake, object = std::weak_ptr(object)] {
    constexpr int kAny = POLLIN | POLLOUT | POLLERR | POLLHUP | POLLRDHUP;
    if (const std::shared_ptr<OpenObject> known = object.lock()) known->changed(kAny);
    wake();
  };
  return object;
}

Process::Answer Process::open_stream(int fd, int family) {
  add_stream(fd, around_.network.streams().open(family, [] {}));
  return {};
}

Process::Answer Process::accept(StreamSocket& listener, std::int64_t fd) {
  if (listener.state != StreamSocket::State::kListening) return {.error = EINVAL};
  if (open_.size() >= kMostOpen) return {.error = EMFILE};
  if (fd < 0 || fd > INT32_MAX) throw BadRequest("accepted into a descriptor that is none");
  const auto place = static_cast<int>(fd);
  if (object_of(place) != nullptr) throw BadRequest("accepted into a descriptor that is taken");
  std::shared_ptr<StreamSocket> stream = around_.network.streams().accept(listener, [] {});
  if (stream == nullptr) return {.error = EAGAIN};
  Answer answer{.data = bytes_of(stream->peer)};
  add_stream(place, std::move(stream));
  return answer;
}

Task<Process::Answer> Process::write(StreamSocket& stream, const Bytes& data) {
  read_head<shim::Departure>(data);  // a stream has its peer
  std::size_t written = 0;
  const int error = co_await around_.network.streams().write(
      stream, std::span(data).subspan(sizeof(shim::Departure)), written);
  co_return Answer{.value = static_cast<std::int64_t>(written), .error = error};
}

Task<Process::Answer> Process::read(StreamSocket& stream, std::int64_t how, std::int64_t most) {
  if (most < 0 || most > static_cast<std::int64_t>(shim::kMostData)) {
    throw BadRequest("asked for too many bytes");
  }
  Answer answer;
  answer.error = co_await around_.network.streams().read(stream, static_cast<std::size_t>(most),
                                                         (how & 2) != 0, answer.data);
  answer.value = static_cast<std::int64_t>(answer.data.size());
  co_return answer;
}

Task<Process::Answer> Process::of_stream(ChildRequest request) {
  // Kept while it is closed.
  const std::shared_ptr<OpenObject> object = object_of(request.head.fd);
  const std::shared_ptr<StreamSocket> stream = object->stream_pointer();
  HostStreams& network = around_.network.streams();
  Answer answer;
  switch (request.head.call) {
    case Call::kBind:
      answer.error = network.bind(*stream, read_head<shim::Address>(request.data));
      co_return answer;
    case Call::kListen:
      answer.error = network.listen(*stream, static_cast<std::size_t>(request.head.a));
      co_return answer;
    case Call::kAccept:
      co_return accept(*stream, request.head.a);
    case Call::kConnect:
      answer.error = co_await network.connect(*stream, read_head<shim::Address>(request.data));
      co_return answer;
    case Call::kSend:
      co_return co_await write(*stream, request.data);
    case Call::kReceive:
      co_return co_await read(*stream, request.head.a, request.head.b);
    case Call::kSetOption:
      answer.error = set_stream_option(*stream, request.head.a, request.head.b);
      co_return answer;
    case Call::kShutDown:
      answer.error = co_await network.shut_down(*stream, static_cast<int>(request.head.a));
      co_return answer;
    default:
      co_return describe(*stream, request.head.call);
  }
}

int Process::set_stream_option(StreamSocket& stream, std::int64_t option, std::int64_t value) {
  switch (static_cast<shim::SocketOption>(option & ~shim::kOfIpv6)) {
    case shim::SocketOption::kOnlyIpv6:
      // Not once it has a port (do_ipv6_setsockopt()).
      if (stream.local.port != 0) return EINVAL;
      stream.only_ipv6 = value != 0;
      return 0;
    case shim::SocketOption::kInterface:
      stream.interface = static_cast<std::uint32_t>(value);
      return 0;
    default:
      return ENOPROTOOPT;
  }
}

Process::Answer Process::describe(StreamSocket& stream, Call call) {
  switch (call) {
    case Call::kName:
      return {.data = bytes_of(stream.local)};
    case Call::kPeerName:
      if (stream.peer.port == 0) return {.error = ENOTCONN};
      return {.data = bytes_of(stream.peer)};
    case Call::kSocketError:
      return {.value = std::exchange(stream.error, 0)};
    case Call::kCountInput:
      return {.value = static_cast<std::int64_t>(stream.input.size())};
    default:
      throw BadRequest("asked of a connection what it does not have");
  }
}

}  // namespace simbench::sim
