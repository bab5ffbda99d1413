#include "sim/programs/host_streams.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cerrno>
#include <utility>

#include "shim/addresses.h"

namespace simbench::sim {
namespace {

// The kinds of the segment and of the addresses in a byte, the sender's port, the receiver's.
constexpr std::size_t kHeadBytes = 5;
constexpr std::size_t kIpv6Bytes = 20;  // by which IPv6's head is longer

Bytes credit_of(std::size_t bytes) {
  Bytes data(4);
  boost::endian::store_big_u32(reinterpret_cast<unsigned char*>(data.data()),
                               static_cast<std::uint32_t>(bytes));
  return data;
}

}  // namespace

std::shared_ptr<StreamSocket> HostStreams::open(int family, std::function<void()> on_change) {
  auto stream = std::make_shared<StreamSocket>();
  stream->family = family;
  stream->local.family = static_cast<std::uint16_t>(family);
  if (family == AF_INET) stream->local.host = shim::mapped(0);
  stream->on_change = std::move(on_change);
  streams_.push_back(stream);
  return stream;
}

bool HostStreams::is_taken(const StreamSocket& by, const shim::Address& address) const {
  return std::ranges::any_of(streams_, [&](const std::shared_ptr<StreamSocket>& each) {
    // Connections that came through a listener have its port.
    return each.get() != &by && each->local.port == address.port && each->peer.port == 0 &&
           overlap({.host = address.host, .only_ipv6 = by.only_ipv6, .interface = by.interface},
                   {.host = each->local.host,
                    .only_ipv6 = each->only_ipv6,
                    .interface = each->interface});
  });
}

int HostStreams::bind(StreamSocket& stream, shim::Address address) {
  if (stream.local.port != 0 || stream.state != StreamSocket::State::kFresh) return EINVAL;
  if (stream.family == AF_INET && !shim::is_ipv4(address.host)) return EAFNOSUPPORT;
  const int obstacle = routes_.check_own(address, stream.only_ipv6, stream.interface);
  if (obstacle != 0) return obstacle;
  address.family = static_cast<std::uint16_t>(stream.family);
  if (address.port == 0) {
    const int error = ports_.give(address, streams_);
    if (error != 0) return error;
  } else if (is_taken(stream, address)) {
    return EADDRINUSE;
  }
  stream.local = address;
  stream.states_host = !shim::is_any(address.host);
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
  if (stream.error != 0) co_return std::exchange(stream.error, 0);
  if (stream.state != StreamSocket::State::kFresh) co_return ECONNABORTED;
  if (peer.family == AF_UNSPEC) co_return EAFNOSUPPORT;
  const bool is_ipv4 = shim::is_ipv4(peer.host);
  const bool states_host = !shim::is_any(stream.local.host);
  if (!is_ipv4 && stream.family == AF_INET) co_return EAFNOSUPPORT;
  if (is_ipv4 && stream.only_ipv6) co_return ENETUNREACH;
  if (states_host && is_ipv4 != shim::is_ipv4(stream.local.host)) co_return EAFNOSUPPORT;
  const Route route = routes_.to(peer, {.interface = stream.interface, .must_name_link = true});
  if (route.error != 0 || route.group) co_return route.error != 0 ? route.error : ENETUNREACH;
  if (shim::is_any(peer.host)) peer.host = route.source;
  if (stream.local.port == 0) {
    const int error = ports_.give(stream.local, streams_);
    if (error != 0) co_return error;
  }
  if (!states_host) {
    stream.local.host = route.source;
    stream.local = scoped(stream.local, route.interface);
  }
  peer.family = static_cast<std::uint16_t>(stream.family);
  stream.peer = scoped(peer, route.interface);
  stream.state = StreamSocket::State::kConnecting;
  co_await transmit(stream, SegmentKind::kOpen);
  co_return EINPROGRESS;
}

Task<int> HostStreams::write(StreamSocket& stream, std::span<const std::byte> data,
                             std::size_t& written) {
  written = 0;
  if (stream.error != 0) co_return std::exchange(stream.error, 0);
  if (stream.has_ended || stream.state == StreamSocket::State::kClosed) co_return EPIPE;
  if (stream.state == StreamSocket::State::kConnecting) co_return EAGAIN;
  if (stream.state != StreamSocket::State::kOpen) co_return EPIPE;
  const std::size_t most = kMostSegment - (shim::is_ipv4(stream.peer.host) ? 0 : kIpv6Bytes);
  while (written < data.size() && stream.on_the_way < kWindow &&
         stream.state == StreamSocket::State::kOpen) {
    const std::size_t size = std::min({data.size() - written, most, kWindow - stream.on_the_way});
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
      return POLLOUT | POLLHUP | (stream.error != 0 ? POLLERR : 0);
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

Bytes HostStreams::head_of(const Segment& segment) {
  const bool is_ipv4 = shim::is_ipv4(segment.to.host);
  Bytes message(kHeadBytes + (is_ipv4 ? 0 : kIpv6Bytes));
  auto* head = reinterpret_cast<unsigned char*>(message.data());
  head[0] = static_cast<unsigned char>(static_cast<unsigned>(segment.kind) |
                                       static_cast<unsigned>(kind_of(segment.from.host)) << 3 |
                                       static_cast<unsigned>(kind_of(segment.to.host)) << 5);
  boost::endian::store_big_u16(head + 1, segment.from.port);
  boost::endian::store_big_u16(head + 3, segment.to.port);
  return message;
}

std::optional<HostStreams::Segment> HostStreams::segment_of(PeerId from,
                                                            const Bytes& message) const {
  if (message.size() < kHeadBytes) return std::nullopt;
  const auto* head = reinterpret_cast<const unsigned char*>(message.data());
  const auto from_kind = static_cast<AddressKind>(head[0] >> 3 & 3);
  const auto to_kind = static_cast<AddressKind>(head[0] >> 5 & 3);
  const std::size_t begin = kHeadBytes + (to_kind == AddressKind::kIpv4 ? 0 : kIpv6Bytes);
  if (message.size() < begin) return std::nullopt;
  return Segment{
      .kind = static_cast<SegmentKind>(head[0] & 7),
      .from = scoped(
          {.host = address_of(from, from_kind), .port = boost::endian::load_big_u16(head + 1)},
          shim::kFirstCard),
      .to = scoped(
          {.host = address_of(host_.id(), to_kind), .port = boost::endian::load_big_u16(head + 3)},
          shim::kFirstCard),
      .data = Bytes(message.begin() + static_cast<std::ptrdiff_t>(begin), message.end())};
}

Task<void> HostStreams::transmit(Segment segment) {
  const std::optional<PeerId> peer = owner_of(segment.to.host, hosts_);
  if (!peer || *peer == host_.id()) {
    co_await take(std::move(segment));
    co_return;
  }
  Bytes message = head_of(segment);
  message.insert(message.end(), segment.data.begin(), segment.data.end());
  MessageChannel& channel = host_.open_channel(*peer, Transport::kStream);
  co_await channel.send(std::move(message));
}

Task<void> HostStreams::pump(PeerId peer) {
  MessageChannel& channel = host_.open_channel(peer, Transport::kStream);
  for (;;) {
    std::optional<ReceivedMessage> message =
        co_await channel.receive(host_.steady_clock().now() + kIdle);
    if (!message) continue;
    std::optional<Segment> segment = segment_of(peer, message->bytes);
    if (segment) co_await take(*std::move(segment));
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
  const bool was_connecting = stream->state == StreamSocket::State::kConnecting;
  if (!apply(*stream, segment)) {
    stream->state = StreamSocket::State::kClosed;
    if (was_connecting) begin_anew(*stream);
  }
  stream->on_change();
}

// One that was refused may connect again, from its port.
void HostStreams::begin_anew(StreamSocket& stream) {
  stream.state = StreamSocket::State::kFresh;
  stream.peer = {};
  if (stream.states_host) return;
  stream.local.host = stream.family == AF_INET ? shim::mapped(0) : shim::IpAddress{};
  stream.local.scope = 0;
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

// The one that states its address, if there is one.
std::shared_ptr<StreamSocket> HostStreams::listener_for(const shim::Address& to) const {
  std::shared_ptr<StreamSocket> best;
  const bool is_ipv4 = shim::is_ipv4(to.host);
  for (const std::shared_ptr<StreamSocket>& each : streams_) {
    if (each->state != StreamSocket::State::kListening || each->local.port != to.port) continue;
    if (is_ipv4 ? each->family == AF_INET6 && each->only_ipv6 : each->family == AF_INET) continue;
    if (each->accepted.size() >= each->backlog) continue;
    if (each->local.host == to.host) return each;
    const bool takes_any =
        shim::is_small(each->local.host, 0) || (is_ipv4 && shim::is_any(each->local.host));
    if (takes_any && (best == nullptr || each->family == AF_INET)) best = each;
  }
  return best;
}

Task<void> HostStreams::take_opening(Segment segment) {
  const std::shared_ptr<StreamSocket> listener = listener_for(segment.to);
  const bool is_refused = listener == nullptr;
  if (!is_refused) {
    const std::shared_ptr<StreamSocket> stream = open(listener->family, [] {});
    stream->state = StreamSocket::State::kOpen;
    stream->only_ipv6 = listener->only_ipv6;
    stream->interface = listener->interface;
    stream->local = segment.to;
    stream->peer = segment.from;
    stream->local.family = stream->peer.family = static_cast<std::uint16_t>(listener->family);
    listener->accepted.push_back(stream);
    listener->on_change();
  }
  co_await transmit(Segment{.kind = is_refused ? SegmentKind::kRefused : SegmentKind::kOpened,
                            .from = segment.to,
                            .to = segment.from});
}

}  // namespace simbench::sim
