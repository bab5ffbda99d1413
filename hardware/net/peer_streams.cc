// The streams of a PeerNetwork: who connects, who is let in, what they carry.
#include <algorithm>
#include <array>
#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>

#include "hardware/net/peer_network_state.h"
#include "hardware/net/wire.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kNewcomers = 64;
constexpr Nanoseconds kHandshakeTime = std::chrono::seconds(2);
constexpr Nanoseconds kFirstRetry = std::chrono::milliseconds(100);
constexpr Nanoseconds kLastRetry = std::chrono::seconds(1);
constexpr Nanoseconds kSendPatience = std::chrono::seconds(1);
constexpr std::size_t kMaxPeerMessage = 64u << 10;

constexpr std::byte kPort{0};
constexpr std::byte kMessage{1};

// A stream's messages are named by the stream and by their number in it.
constexpr unsigned kNumberBits = 40;
constexpr MessageId kNeverSent = ~MessageId{0};

Bytes port_message(std::uint16_t port) {
  Bytes message(3, kPort);
  put_number(std::span(message).last(2), port);
  return message;
}

}  // namespace

Task<void> PeerNetwork::State::accept_connections(Self self) {
  while (!self->stopped_) {
    tcp::socket socket(self->context_);
    error_code error;
    co_await self->acceptor_.async_accept(
        socket, boost::asio::redirect_error(boost::asio::use_awaitable, error));
    if (self->stopped_) co_return;
    if (error) {
      // Such as no file numbers left: the connections wait in the kernel meanwhile.
      co_await self->stopping_.wait(monotonic_now() + kFirstRetry);
      continue;
    }
    self->greet(std::move(socket));
  }
}

void PeerNetwork::State::greet(tcp::socket socket) {
  error_code gone;
  const auto from = socket.remote_endpoint(gone).address();
  if (gone || !connections_allowed_.take(from, 0, monotonic_now())) {
    ++statistics_.refused_connections;
    return;
  }
  if (newcomers_.size() >= kNewcomers) refuse_one_newcomer();
  newcomers_.emplace_back();
  const auto newcomer = std::prev(newcomers_.end());
  newcomer->from = from;
  boost::asio::co_spawn(
      context_,
      SecureStream::accept(std::move(socket), settings_.key, PeerName{settings_.me},
                           monotonic_now() + kHandshakeTime),
      boost::asio::bind_cancellation_slot(
          newcomer->refuse.slot(),
          [self = shared_from_this(), newcomer](const std::exception_ptr& refused,
                                                std::unique_ptr<SecureStream> stream) {
            self->newcomers_.erase(newcomer);
            if (refused) {
              ++self->statistics_.refused_connections;
            } else if (!self->stopped_) {
              self->admit(std::move(stream));
            }
          }));
}

// The oldest of the address that has most of them: who floods refuses its own.
void PeerNetwork::State::refuse_one_newcomer() {
  const auto of_address = [this](const boost::asio::ip::address& from) {
    return std::ranges::count(newcomers_, from, &Newcomer::from);
  };
  const auto most = std::ranges::max_element(
      newcomers_, {}, [&of_address](const Newcomer& one) { return of_address(one.from); });
  most->refuse.emit(boost::asio::cancellation_type::terminal);
}

void PeerNetwork::State::admit(std::unique_ptr<SecureStream> stream) {
  const std::uint32_t host = stream->peer().host;
  if (host == PeerName::kConductor && on_conductor_) return on_conductor_(std::move(stream));
  // Hosts of lower number are connected to from here.
  if (host <= settings_.me || host >= links_.size()) {
    ++statistics_.refused_connections;
    return;
  }
  boost::asio::co_spawn(context_, serve(shared_from_this(), host, std::move(stream)),
                        boost::asio::detached);
}

Task<void> PeerNetwork::State::keep_connected(Self self, PeerId peer) {
  Nanoseconds pause = kFirstRetry;
  while (!self->stopped_) {
    std::shared_ptr<SecureStream> stream = co_await connect_to(self, peer);
    if (stream && !self->stopped_) {
      pause = kFirstRetry;
      co_await serve(self, peer, std::move(stream));
    }
    if (self->stopped_) co_return;
    co_await self->stopping_.wait(monotonic_now() + pause);
    pause = std::min(2 * pause, kLastRetry);
  }
}

// Nothing if there is no connection now, or another than that host at its address.
Task<std::unique_ptr<SecureStream>> PeerNetwork::State::connect_to(Self self, PeerId peer) {
  const PeerAddress at = self->settings_.peers[peer];
  std::unique_ptr<SecureStream> stream;
  try {
    stream = co_await SecureStream::connect(self->context_, at.address, at.port,
                                            self->settings_.key, PeerName{self->settings_.me},
                                            monotonic_now() + kHandshakeTime);
  } catch (const StreamError& error) {
    if (error.kind() != StreamError::Kind::kUnreachable) ++self->statistics_.refused_connections;
  }
  if (stream && stream->peer() != PeerName{peer}) {
    ++self->statistics_.refused_connections;
    stream.reset();
  }
  co_return stream;
}

// Until the stream has ended.
Task<void> PeerNetwork::State::serve(Self self, PeerId peer, std::shared_ptr<SecureStream> stream) {
  Link& link = self->link(peer);
  self->take_over(link, stream);
  for (;;) {
    auto message = co_await next_of(stream);
    if (!message || self->stopped_ || !self->route(link, std::move(*message))) break;
  }
  stream->close();
  if (link.stream == stream) link.stream.reset();
}

Task<std::optional<StreamMessage>> PeerNetwork::State::next_of(
    std::shared_ptr<SecureStream> stream) {
  try {
    co_return co_await stream->receive(MonotonicTime::max());
  } catch (const StreamError&) {
    co_return std::nullopt;
  }
}

void PeerNetwork::State::take_over(Link& link, const std::shared_ptr<SecureStream>& stream) {
  if (link.stream) link.stream->close();
  link.stream = stream;
  if (++link.streams > 1) ++statistics_.reconnections;
  link.session.emplace(*stream, static_cast<std::uint16_t>(settings_.me),
                       static_cast<std::uint16_t>(link.peer));
  link.datagrams_to = destination(link, *stream);
  link.proven_source.reset();
  boost::asio::co_spawn(context_, stream->send(port_message(port_)), boost::asio::detached);
  link.connected.notify();
}

// False if the peer sent what is not allowed.
bool PeerNetwork::State::route(Link& link, StreamMessage message) {
  const std::size_t size = message.bytes.size();
  if (size == 3 && message.bytes[0] == kPort) {
    if (link.datagrams_to.port() == 0) {
      const std::span<const std::byte> all(message.bytes);
      link.datagrams_to.port(static_cast<std::uint16_t>(number_in(all.last(2))));
    }
    return true;
  }
  if (size == 0 || size > kMaxPeerMessage + 1 || message.bytes[0] != kMessage) {
    ++statistics_.refused_malformed;
    return false;
  }
  message.bytes.erase(message.bytes.begin());
  deliver(link, Transport::kStream, std::move(message.bytes), message.received);
  return true;
}

Task<MessageId> PeerNetwork::State::send_by_stream(Self self, PeerId peer, Bytes message) {
  if (message.size() > kMaxPeerMessage) {
    throw StreamError(StreamError::Kind::kNotUnderstood,
                      "found a message to a host that is too long, allowed: 65536 bytes");
  }
  Link& link = self->link(peer);
  const MonotonicTime patience = monotonic_now() + kSendPatience;
  while (!link.stream && !self->stopped_) {
    const bool in_time = co_await link.connected.wait(patience);
    if (!in_time) break;
  }
  const std::shared_ptr<SecureStream> stream = link.stream;
  if (!stream || self->stopped_) co_return kNeverSent;
  const std::uint64_t which = link.streams;
  message.insert(message.begin(), kMessage);
  try {
    const MessageId number = co_await stream->send(std::move(message));
    co_return which << kNumberBits | number;
  } catch (const StreamError&) {
    co_return kNeverSent;
  }
}

Task<std::optional<HostTime>> PeerNetwork::State::stream_stamp(Self self, PeerId peer, MessageId id,
                                                               SteadyTime deadline) {
  if (self->stopped_) co_return std::nullopt;
  const Link& link = self->link(peer);
  const std::shared_ptr<SecureStream> stream = link.stream;
  if (!stream || id >> kNumberBits != link.streams) co_return std::nullopt;
  const MessageId number = id & ((MessageId{1} << kNumberBits) - 1);
  const auto left = co_await stream->transmit_stamp(number, self->deadline_of(deadline));
  if (!left || self->stopped_) co_return std::nullopt;
  co_return self->clock_.system_at(*left);
}

}  // namespace simbench::hardware
