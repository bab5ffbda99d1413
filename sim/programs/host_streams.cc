#include "sim/programs/host_streams.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cerrno>
#include <utility>

#include "processes/placeholders.h"

namespace simbench::sim {
namespace {

constexpr std::size_t kHeadBytes = 5;  // the kind, the sender's port, the receiver's

Bytes credit_of(std::size_t bytes) {
  Bytes data(4);
  boost::endian::store_big_u32(reinterpret_cast<unsigned char*>(data.data()),
                               static_cast<std::uint32_t>(bytes));
  return data;
}

}  // namespace

std::uint32_t HostStreams::own_address() const { return processes::address_of(host_.id()); }

bool HostStreams::is_own(std::uint32_t address) const {
  return address == own_address() || address >> 24 == 127;
}

std::shared_ptr<StreamSocket> HostStreams::open(std::function<void()> on_change) {
  auto stream = std::make_shared<StreamSocket>();
  stream->on_change = std::move(on_change);
  streams_.push_back(stream);
  return stream;
}

int HostStreams::bind(StreamSocket& stream, shim::Address address) {
  if (stream.local.port != 0 || stream.state != StreamSocket::State::kFresh) return EINVAL;
  if (address.host != 0 && !is_own(address.host)) return EADDRNOTAVAIL;
  if (address.port == 0) {
    stream.local.host = address.host;
    return ports_.give(stream.local, streams_);
  }
  const bool is_taken =
      std::ranges::any_of(streams_, [&](const std::shared_ptr<StreamSocket>& each) {
        const bool is_same_host =
            each->local.host == 0 || address.host == 0 || each->local.host == address.host;
        // Connections that came through a listener have its port.
        return each->local.port == address.port && is_same_host && each->peer.port == 0;
      });
  if (is_taken) return EADDRINUSE;
  stream.local = address;
  return 0;
}

int HostStreams::listen(StreamSocket& stream, std::size_t backlog) {
  const bool listens = stream.state == StreamSocket::State::kListening;
  if (!listens && stream.state != StreamSocket::State::kFresh) return EINVAL;
  if (stream.local.port == 0) {
    const int error = ports_.give(stream.local, streams_);
    if (error != 0) return error;
  }
  stream.state = StreamSocket::State::kListening;
  stream.backlog = std::clamp(backlog, std::size_t{1}, kMostBacklog);
  return 0;
}

std::shared_ptr<StreamSocket> HostStreams::accept(StreamSocket& listener,
                                                  std::function<void()> on_change) {
  if (listener.accepted.empty()) return nullptr;
  std::shared_ptr<StreamSocket> stream = std::move(listener.accepted.front());
  listener.accepted.pop_front();
  stream->on_change = std::move(on_change);
  return stream;
}

Task<int> HostStreams::connect(StreamSocket& stream, shim::Address peer) {
  if (stream.state == StreamSocket::State::kConnecting) co_return EALREADY;
  if (stream.state == StreamSocket::State::kOpen) co_return EISCONN;
  if (stream.state != StreamSocket::State::kFresh) co_return ECONNABORTED;
  const std::uint32_t number = peer.host - processes::kFirstAddress;
  if (!is_own(peer.host) && number >= hosts_) co_return ENETUNREACH;
  if (stream.local.port == 0) {
    const int error = ports_.give(stream.local, streams_);
    if (error != 0) co_return error;
  }
  stream.local.host = peer.host >> 24 == 127 ? peer.host : own_address();
  stream.peer = peer;
  stream.state = StreamSocket::State::kConnecting;
  co_await transmit(stream, SegmentKind::kOpen);
  co_return stream.state == StreamSocket::State::kConnecting ? EINPROGRESS
                                                             : std::exchange(stream.error, 0);
}

Task<int> HostStreams::write(StreamSocket& stream, std::span<const std::byte> data,
                             std::size_t& written) {
  written = 0;
  if (stream.error != 0) co_return std::exchange(stream.error, 0);
  if (stream.has_ended || stream.state == StreamSocket::State::kClosed) co_return EPIPE;
  if (stream.state == StreamSocket::State::kConnecting) co_return EAGAIN;
  if (stream.state != StreamSocket::State::kOpen) co_return ENOTCONN;
  while (written < data.size() && stream.on_the_way < kWindow &&
         stream.state == StreamSocket::State::kOpen) {
    const std::size_t size =
        std::min({data.size() - written, kMostSegment, kWindow - stream.on_the_way});
    const auto piece = data.subspan(written, size);
    stream.on_the_way += size;
    written += size;
    co_await transmit(stream, SegmentKind::kData, Bytes(piece.begin(), piece.end()));
  }
  co_return written == 0 && !data.empty() ? EAGAIN : 0;
}

Task<int> HostStreams::read(StreamSocket& stream, std::size_t most, bool leaves_it, Bytes& data) {
  data.clear();
  if (stream.input.empty()) {
    if (stream.error != 0) co_return std::exchange(stream.error, 0);
    if (stream.peer_ended || stream.state == StreamSocket::State::kClosed) co_return 0;
    const bool may_come = stream.state == StreamSocket::State::kOpen ||
                          stream.state == StreamSocket::State::kConnecting;
    co_return may_come ? EAGAIN : ENOTCONN;
  }
  const auto size = static_cast<std::ptrdiff_t>(std::min(most, stream.input.size()));
  data.assign(stream.input.begin(), stream.input.begin() + size);
  if (leaves_it) co_return 0;
  stream.input.erase(stream.input.begin(), stream.input.begin() + size);
  stream.to_credit += data.size();
  co_await give_credit(stream, kWindow / 2);
  co_return 0;
}

Task<void> HostStreams::give_credit(StreamSocket& stream, std::size_t at_least) {
  if (stream.to_credit < at_least || stream.state != StreamSocket::State::kOpen) co_return;
  const std::size_t bytes = std::exchange(stream.to_credit, 0);
  co_await transmit(stream, SegmentKind::kCredit, credit_of(bytes));
}

Task<int> HostStreams::shut_down(StreamSocket& stream, int how) {
  if (stream.state != StreamSocket::State::kOpen) co_return ENOTCONN;
  if (how != SHUT_WR) stream.peer_ended = true;
  if (how == SHUT_RD || stream.has_ended) co_return 0;
  stream.has_ended = true;
  co_await transmit(stream, SegmentKind::kEnd);
  co_return 0;
}

Task<void> HostStreams::close(std::shared_ptr<StreamSocket> stream) {
  std::erase(streams_, stream);
  stream->on_change = [] {};
  for (const std::shared_ptr<StreamSocket>& each : stream->accepted) {
    std::erase(streams_, each);
    co_await transmit(*each, SegmentKind::kRefused);
  }
  const bool is_connected = stream->state == StreamSocket::State::kOpen ||
                            stream->state == StreamSocket::State::kConnecting;
  stream->state = StreamSocket::State::kClosed;
  if (!is_connected) co_return;
  // What was not read is lost, and the peer hears of it.
  if (!stream->input.empty()) {
    co_await transmit(*stream, SegmentKind::kRefused);
  } else if (!stream->has_ended) {
    co_await transmit(*stream, SegmentKind::kEnd);
  }
}

int HostStreams::readiness(const StreamSocket& stream) {
  switch (stream.state) {
    case StreamSocket::State::kFresh:
      return POLLOUT | POLLHUP;
    case StreamSocket::State::kListening:
      return stream.accepted.empty() ? 0 : POLLIN;
    case StreamSocket::State::kConnecting:
      return 0;
    case StreamSocket::State::kClosed:
      return POLLIN | POLLOUT | POLLHUP | (stream.error != 0 ? POLLERR : 0);
    case StreamSocket::State::kOpen:
      break;
  }
  const int input = !stream.input.empty() || stream.peer_ended ? POLLIN : 0;
  const int output = stream.on_the_way < kWindow || stream.has_ended ? POLLOUT : 0;
  const int end =
      (stream.peer_ended ? POLLRDHUP : 0) | (stream.peer_ended && stream.has_ended ? POLLHUP : 0);
  return input | output | end;
}

std::shared_ptr<StreamSocket> HostStreams::find(const shim::Address& local,
                                                const shim::Address& peer) const {
  const auto found = std::ranges::find_if(streams_, [&](const std::shared_ptr<StreamSocket>& each) {
    return each->local.port == local.port && each->peer.port == peer.port &&
           each->peer.host == peer.host;
  });
  return found == streams_.end() ? nullptr : *found;
}

Task<void> HostStreams::transmit(const StreamSocket& stream, SegmentKind kind, Bytes data) {
  return transmit(
      Segment{.kind = kind, .from = stream.local, .to = stream.peer, .data = std::move(data)});
}

Task<void> HostStreams::transmit(Segment segment) {
  if (is_own(segment.to.host)) {
    co_await take(std::move(segment));
    co_return;
  }
  Bytes message(kHeadBytes + segment.data.size());
  auto* head = reinterpret_cast<unsigned char*>(message.data());
  head[0] = static_cast<unsigned char>(segment.kind);
  boost::endian::store_big_u16(head + 1, segment.from.port);
  boost::endian::store_big_u16(head + 3, segment.to.port);
  std::ranges::copy(segment.data, message.begin() + kHeadBytes);
  const PeerId peer = segment.to.host - processes::kFirstAddress;
  MessageChannel& channel = host_.open_channel(peer, Transport::kStream);
  co_await channel.send(std::move(message));
}

Task<void> HostStreams::pump(PeerId peer) {
  MessageChannel& channel = host_.open_channel(peer, Transport::kStream);
  for (;;) {
    std::optional<ReceivedMessage> message =
        co_await channel.receive(host_.steady_clock().now() + kIdle);
    if (!message || message->bytes.size() < kHeadBytes) continue;
    const Bytes& bytes = message->bytes;
    const auto* head = reinterpret_cast<const unsigned char*>(bytes.data());
    Segment segment{
        .kind = static_cast<SegmentKind>(head[0]),
        .from = {.host = processes::address_of(peer),
                 .port = boost::endian::load_big_u16(head + 1),
                 .reserved = 0},
        .to = {.host = own_address(), .port = boost::endian::load_big_u16(head + 3), .reserved = 0},
        .data = Bytes(bytes.begin() + kHeadBytes, bytes.end())};
    co_await take(std::move(segment));
  }
}

Task<void> HostStreams::take(Segment segment) {
  if (segment.kind == SegmentKind::kOpen) {
    co_await take_opening(std::move(segment));
    co_return;
  }
  const std::shared_ptr<StreamSocket> stream = find(segment.to, segment.from);
  if (stream == nullptr) {
    // Nobody is there to read it.
    if (segment.kind != SegmentKind::kData && segment.kind != SegmentKind::kOpened) co_return;
    co_await transmit(
        Segment{.kind = SegmentKind::kRefused, .from = segment.to, .to = segment.from});
    co_return;
  }
  if (!apply(*stream, segment)) stream->state = StreamSocket::State::kClosed;
  stream->on_change();
}

bool HostStreams::apply(StreamSocket& stream, Segment& segment) {
  switch (segment.kind) {
    case SegmentKind::kOpened:
      stream.state = StreamSocket::State::kOpen;
      return true;
    case SegmentKind::kData:
      stream.input.insert(stream.input.end(), segment.data.begin(), segment.data.end());
      return true;
    case SegmentKind::kEnd:
      stream.peer_ended = true;
      return true;
    case SegmentKind::kCredit:
      if (segment.data.size() == 4) {
        const std::size_t read = boost::endian::load_big_u32(
            reinterpret_cast<const unsigned char*>(segment.data.data()));
        stream.on_the_way -= std::min(read, stream.on_the_way);
      }
      return true;
    case SegmentKind::kRefused:
    case SegmentKind::kOpen:
      break;
  }
  stream.error = stream.state == StreamSocket::State::kConnecting ? ECONNREFUSED : ECONNRESET;
  return false;
}

Task<void> HostStreams::take_opening(Segment segment) {
  const auto found = std::ranges::find_if(streams_, [&](const std::shared_ptr<StreamSocket>& each) {
    return each->state == StreamSocket::State::kListening && each->local.port == segment.to.port &&
           (each->local.host == 0 || each->local.host == segment.to.host) &&
           each->accepted.size() < each->backlog;
  });
  const bool is_refused = found == streams_.end();
  if (!is_refused) {
    const std::shared_ptr<StreamSocket> listener = *found;
    const std::shared_ptr<StreamSocket> stream = open([] {});
    stream->state = StreamSocket::State::kOpen;
    stream->local = segment.to;
    stream->peer = segment.from;
    listener->accepted.push_back(stream);
    listener->on_change();
  }
  co_await transmit(Segment{.kind = is_refused ? SegmentKind::kRefused : SegmentKind::kOpened,
                            .from = segment.to,
                            .to = segment.from});
}

}  // namespace simbench::sim
