// The requests that concern connections.
#include <sys/socket.h>

#include <cerrno>
#include <span>
#include <utility>

#include "sim/programs/process.h"

namespace simbench::sim {

using shim::Call;

bool Process::is_of_stream(const ChildRequest& request) const {
  return request.head.call != Call::kWait && streams_.contains(request.head.fd);
}

Process::Answer Process::open_stream(int fd, int family) {
  streams_[fd] = network_.streams().open(family, [this] { woken_.notify(); });
  return {};
}

Process::Answer Process::accept(StreamSocket& listener, std::int64_t fd) {
  if (listener.state != StreamSocket::State::kListening) return {.error = EINVAL};
  if (open_descriptors() >= kMostOpen) return {.error = EMFILE};
  if (fd < 0 || fd > INT32_MAX) throw BadRequest("accepted into a descriptor that is none");
  const auto place = static_cast<int>(fd);
  if (sockets_.contains(place) || streams_.contains(place) || timers_.contains(place)) {
    throw BadRequest("accepted into a descriptor that is taken");
  }
  std::shared_ptr<StreamSocket> stream =
      network_.streams().accept(listener, [this] { woken_.notify(); });
  if (stream == nullptr) return {.error = EAGAIN};
  Answer answer{.data = bytes_of(stream->peer)};
  streams_[place] = std::move(stream);
  return answer;
}

Task<Process::Answer> Process::write(StreamSocket& stream, const Bytes& data) {
  read_head<shim::Departure>(data);  // a stream has its peer
  std::size_t written = 0;
  const int error = co_await network_.streams().write(
      stream, std::span(data).subspan(sizeof(shim::Departure)), written);
  co_return Answer{.value = static_cast<std::int64_t>(written), .error = error};
}

Task<Process::Answer> Process::read(StreamSocket& stream, std::int64_t how, std::int64_t most) {
  if (most < 0 || most > static_cast<std::int64_t>(shim::kMostData)) {
    throw BadRequest("asked for too many bytes");
  }
  Answer answer;
  answer.error = co_await network_.streams().read(stream, static_cast<std::size_t>(most),
                                                  (how & 2) != 0, answer.data);
  answer.value = static_cast<std::int64_t>(answer.data.size());
  co_return answer;
}

Task<Process::Answer> Process::of_stream(ChildRequest request) {
  // Kept while it is closed.
  const std::shared_ptr<StreamSocket> stream = streams_.at(request.head.fd);
  HostStreams& network = network_.streams();
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
    case Call::kClose:
      streams_.erase(request.head.fd);
      co_await network.close(stream);
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

Task<void> Process::close_streams() {
  while (!streams_.empty()) {
    const std::shared_ptr<StreamSocket> stream = std::move(streams_.begin()->second);
    streams_.erase(streams_.begin());
    co_await network_.streams().close(stream);
  }
}

}  // namespace simbench::sim
