#include "hardware/net/peer_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/socket_base.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "algorithms/ports/assert.h"
#include "hardware/net/connect.h"
#include "hardware/net/datagram.h"
#include "hardware/net/datagram_socket.h"
#include "hardware/net/newcomers.h"
#include "hardware/net/notice.h"
#include "hardware/net/token_bucket.h"
#include "hardware/net/wire.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::tcp;
using boost::asio::ip::udp;
using boost::system::error_code;

// Datagrams from one source that has not proved the key.
constexpr double kStrangersPerSecond = 200;
constexpr double kStrangersAtOnce = 64;
// Datagrams read in a row before others get their turn.
constexpr int kDatagramsAtOnce = 64;

constexpr Nanoseconds kFirstRetry = std::chrono::milliseconds(100);
constexpr Nanoseconds kLastRetry = std::chrono::seconds(1);
constexpr Nanoseconds kSendPatience = std::chrono::seconds(1);
constexpr std::size_t kMaxPeerMessage = 64u << 10;

// The transports in the order of their values.
constexpr std::array kTransports = {Transport::kStream, Transport::kDatagram,
                                    Transport::kAlignment};

constexpr std::byte kPort{0};
constexpr std::byte kMessage{1};

// The id of a stream's message joins the number of the stream and its own number in it.
constexpr unsigned kNumberBits = 40;
constexpr MessageId kNeverSent = ~MessageId{0};

Bytes port_message(std::uint16_t port) {
  Bytes message(3, kPort);
  put_number(std::span(message).last(2), port);
  return message;
}

}  // namespace

// The inside of a PeerNetwork, held by it and by every pending operation. stop() ends these; after
// it the node's clock is not used.
//
// A stream between hosts carries messages of one tag byte and their content: kPort, two bytes, once
// at the start (the sender's datagram port, which a rig file may not state), and kMessage, a
// message of the stream channel.
class PeerNetwork::State : public std::enable_shared_from_this<State> {
 public:
  using Self = std::shared_ptr<State>;
  using ConductorHandler = std::function<void(std::unique_ptr<SecureStream>)>;

  State(boost::asio::io_context& context, PeerNetworkSettings settings, NodeClock& clock);

  void start();
  void stop();
  void on_conductor(ConductorHandler handler) { on_conductor_ = std::move(handler); }
  std::uint16_t port() const { return port_; }
  MessageChannel& channel(PeerId peer, Transport transport);
  void clear();
  bool connected(PeerId peer) const;
  const NetworkStatistics& statistics() const { return statistics_; }

  // The operations of the channels.
  static Task<MessageId> send_by_stream(Self self, PeerId peer, Bytes message);
  MessageId send_datagram(PeerId peer, Transport transport, const Bytes& message);
  static Task<std::optional<ReceivedMessage>> receive(Self self, PeerId peer, Transport transport,
                                                      SteadyTime deadline);
  static Task<std::optional<HostTime>> stream_stamp(Self self, PeerId peer, MessageId id,
                                                    SteadyTime deadline);
  static Task<std::optional<HostTime>> datagram_stamp(Self self, MessageId id, SteadyTime deadline);

 private:
  class Channel;

  // Everything about one other host.
  struct Link {
    Link(State& state, PeerId of);
    Inbox& inbox(Transport transport) { return *inboxes[static_cast<std::size_t>(transport)]; }

    PeerId peer;
    std::shared_ptr<SecureStream> stream;  // null while the link is down
    std::uint64_t streams = 0;             // how many there were
    std::optional<DatagramSession> session;
    boost::asio::ip::udp::endpoint datagrams_to;
    // The source of its last authentic datagram.
    std::optional<boost::asio::ip::udp::endpoint> proven_source;
    Notice connected;
    std::array<std::unique_ptr<Inbox>, kTransports.size()> inboxes;     // by Transport
    std::array<std::unique_ptr<Channel>, kTransports.size()> channels;  // likewise
  };

  void bind_sockets();
  Link& link(PeerId peer);
  MonotonicTime deadline_of(SteadyTime deadline) const;
  void deliver(Link& link, Transport transport, Bytes message, MonotonicTime received);

  // Streams: connecting, admitting, routing.
  static Task<void> accept_connections(Self self);
  void admit(std::unique_ptr<SecureStream> stream);
  static Task<void> keep_connected(Self self, PeerId peer);
  static Task<std::unique_ptr<SecureStream>> connect_to(Self self, PeerId peer);
  static Task<void> serve(Self self, PeerId peer, std::shared_ptr<SecureStream> stream);
  static Task<std::optional<StreamMessage>> next_of(std::shared_ptr<SecureStream> stream);
  void take_over(Link& link, const std::shared_ptr<SecureStream>& stream);
  bool route(Link& link, StreamMessage message);

  static Task<void> receive_datagrams(Self self);
  void judge_datagram(const DatagramSocket::Received& datagram);
  boost::asio::ip::udp::endpoint destination(const Link& link, const SecureStream& stream) const;

  boost::asio::io_context& context_;
  PeerNetworkSettings settings_;
  NodeClock& clock_;
  ConductorHandler on_conductor_;
  bool stopped_ = false;
  Notice stopping_;
  NetworkStatistics statistics_;
  std::vector<std::unique_ptr<Link>> links_;  // by host; null for this one

  std::uint16_t port_ = 0;
  boost::asio::ip::tcp::acceptor acceptor_;
  Newcomers newcomers_;

  DatagramSocket datagrams_;
  SourceBuckets strangers_allowed_;
  MessageId next_datagram_ = 0;
};

class PeerNetwork::State::Channel final : public MessageChannel {
 public:
  Channel(State& state, PeerId peer, Transport transport)
      : state_(state), peer_(peer), transport_(transport) {}

  Task<MessageId> send(Bytes message) override {
    if (transport_ == Transport::kStream) {
      return send_by_stream(state_.shared_from_this(), peer_, std::move(message));
    }
    return send_at_once(state_.shared_from_this(), peer_, transport_, std::move(message));
  }
  Task<std::optional<ReceivedMessage>> receive(SteadyTime deadline) override {
    return State::receive(state_.shared_from_this(), peer_, transport_, deadline);
  }
  Task<std::optional<HostTime>> transmit_stamp(MessageId id, SteadyTime deadline) override {
    if (transport_ == Transport::kStream) {
      return stream_stamp(state_.shared_from_this(), peer_, id, deadline);
    }
    return datagram_stamp(state_.shared_from_this(), id, deadline);
  }
  Task<std::optional<HardwareTime>> hardware_transmit_stamp(MessageId /*id*/,
                                                            SteadyTime /*deadline*/) override {
    co_return std::nullopt;
  }

 private:
  static Task<MessageId> send_at_once(Self self, PeerId peer, Transport transport, Bytes message) {
    co_return self->send_datagram(peer, transport, message);
  }

  State& state_;
  PeerId peer_;
  Transport transport_;
};

PeerNetwork::State::Link::Link(State& state, PeerId of)
    : peer(of), connected(state.context_.get_executor()) {
  for (std::size_t i = 0; i < kTransports.size(); ++i) {
    inboxes[i] = std::make_unique<Inbox>(state.context_.get_executor());
    channels[i] = std::make_unique<Channel>(state, of, kTransports[i]);
  }
}

PeerNetwork::State::State(boost::asio::io_context& context, PeerNetworkSettings settings,
                          NodeClock& clock)
    : context_(context),
      settings_(std::move(settings)),
      clock_(clock),
      stopping_(context.get_executor()),
      acceptor_(context),
      newcomers_(context, settings_.key, PeerName{settings_.me}),
      datagrams_(context),
      strangers_allowed_(kStrangersPerSecond, kStrangersAtOnce) {
  links_.resize(settings_.peers.size());
  for (PeerId peer = 0; peer < links_.size(); ++peer) {
    if (peer != settings_.me) links_[peer] = std::make_unique<Link>(*this, peer);
  }
  bind_sockets();
}

void PeerNetwork::State::bind_sockets() {
  const std::string where = address_text(settings_.listen.address, settings_.listen.port);
  const auto address = resolved_now(settings_.listen.address);
  if (!settings_.key.is_secret() && !address.is_loopback()) {
    throw StreamError(
        StreamError::Kind::kWrongKey,
        fmt::format("{}: found no key to listen there with, allowed without one: 127.0.0.1 and "
                    "::1; make one with: simbench keygen FILE",
                    where));
  }
  error_code error;
  // The free port for connections may be taken by another program for datagrams.
  for (int attempt = 0; attempt < 16; ++attempt) {
    acceptor_ = tcp::acceptor(context_);
    const tcp::endpoint wanted(address, settings_.listen.port);
    acceptor_.open(wanted.protocol(), error);
    if (!error) acceptor_.set_option(boost::asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(wanted, error);
    if (!error) acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
    if (!error) port_ = acceptor_.local_endpoint(error).port();
    if (!error) datagrams_.bind({address, port_}, error);
    if (!error || settings_.listen.port != 0) break;
  }
  if (error) {
    throw StreamError(
        StreamError::Kind::kUnreachable,
        fmt::format("{}: cannot listen there: {}; allowed: an address of this machine, and a port "
                    "that no other program (another simbench node?) has",
                    where, error.message()));
  }
}

void PeerNetwork::State::start() {
  const auto self = shared_from_this();
  boost::asio::co_spawn(context_, accept_connections(self), boost::asio::detached);
  boost::asio::co_spawn(context_, receive_datagrams(self), boost::asio::detached);
  for (PeerId peer = 0; peer < settings_.me && peer < links_.size(); ++peer) {
    boost::asio::co_spawn(context_, keep_connected(self, peer), boost::asio::detached);
  }
}

void PeerNetwork::State::stop() {
  stopped_ = true;
  error_code ignored;
  acceptor_.close(ignored);
  datagrams_.close();
  newcomers_.refuse_all();
  for (const auto& link : links_) {
    if (!link) continue;
    if (link->stream) link->stream->close();
    for (const auto& inbox : link->inboxes) inbox->close();
    link->connected.notify();
  }
  stopping_.notify();
  on_conductor_ = nullptr;
}

PeerNetwork::State::Link& PeerNetwork::State::link(PeerId peer) {
  SIMBENCH_ASSERT(peer < links_.size() && links_[peer], "a channel to another host of the rig");
  return *links_[peer];
}

MessageChannel& PeerNetwork::State::channel(PeerId peer, Transport transport) {
  return *link(peer).channels[static_cast<std::size_t>(transport)];
}

void PeerNetwork::State::clear() {
  for (const auto& link : links_) {
    if (!link) continue;
    for (const auto& inbox : link->inboxes) inbox->clear();
  }
}

bool PeerNetwork::State::connected(PeerId peer) const {
  return peer < links_.size() && links_[peer] && links_[peer]->stream;
}

MonotonicTime PeerNetwork::State::deadline_of(SteadyTime deadline) const {
  return clock_.oscillator().when(deadline);
}

void PeerNetwork::State::deliver(Link& link, Transport transport, Bytes message,
                                 MonotonicTime received) {
  statistics_.dropped_full_queue +=
      link.inbox(transport).push(ReceivedMessage{.bytes = std::move(message),
                                                 .received = clock_.system_at(received),
                                                 .received_steady = clock_.steady_at(received),
                                                 .received_hardware = std::nullopt});
}

Task<std::optional<ReceivedMessage>> PeerNetwork::State::receive(Self self, PeerId peer,
                                                                 Transport transport,
                                                                 SteadyTime deadline) {
  if (self->stopped_) co_return std::nullopt;
  co_return co_await self->link(peer).inbox(transport).next(self->deadline_of(deadline));
}

Task<void> PeerNetwork::State::accept_connections(Self self) {
  while (!self->stopped_) {
    tcp::socket socket(self->context_);
    error_code error;
    co_await self->acceptor_.async_accept(
        socket, boost::asio::redirect_error(boost::asio::use_awaitable, error));
    if (self->stopped_) co_return;
    if (error) {
      // Such as too many open files; the connections wait in the kernel meanwhile.
      co_await self->stopping_.wait(monotonic_now() + kFirstRetry);
      continue;
    }
    self->newcomers_.greet(std::move(socket), [self](std::unique_ptr<SecureStream> stream) {
      if (!stream) ++self->statistics_.refused_connections;
      if (stream && !self->stopped_) self->admit(std::move(stream));
    });
  }
}

void PeerNetwork::State::admit(std::unique_ptr<SecureStream> stream) {
  const std::uint32_t host = stream->peer().host;
  if (host == PeerName::kConductor && on_conductor_) return on_conductor_(std::move(stream));
  // This host connects to hosts of lower number itself.
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

// Null if there is no connection now, or if another host answers at the address.
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

// Returns when the stream has ended.
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

// False if the peer broke the protocol.
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

// The rig file's address if it is numeric, else the stream's remote address; the rig file's port,
// or the one that the host sends.
udp::endpoint PeerNetwork::State::destination(const Link& link, const SecureStream& stream) const {
  const PeerAddress& configured = settings_.peers[link.peer];
  error_code no_number;
  auto address = boost::asio::ip::make_address(configured.address, no_number);
  if (no_number) address = stream.remote();
  if (address.is_v4() && !address.is_unspecified() && datagrams_.is_ip6()) {
    address = boost::asio::ip::make_address_v6(boost::asio::ip::v4_mapped, address.to_v4());
  }
  return {address, configured.port};
}

Task<void> PeerNetwork::State::receive_datagrams(Self self) {
  while (!self->stopped_) {
    const bool open = co_await self->datagrams_.readable();
    if (!open || self->stopped_) co_return;
    for (int i = 0; i < kDatagramsAtOnce; ++i) {
      const auto datagram = self->datagrams_.receive();
      if (!datagram) break;
      self->judge_datagram(*datagram);
    }
  }
}

void PeerNetwork::State::judge_datagram(const DatagramSocket::Received& datagram) {
  ++statistics_.datagrams_received;
  const auto header = datagram.truncated ? std::nullopt : parse_datagram(datagram.bytes);
  if (!header || header->from >= links_.size() || !links_[header->from]) {
    ++statistics_.refused_malformed;
    return;
  }
  Link& link = *links_[header->from];
  if (!link.session) {
    ++statistics_.refused_forged;
    return;
  }
  const DatagramSocket::Endpoint& from = datagram.from;
  if (link.proven_source != from && from != link.datagrams_to &&
      !strangers_allowed_.take(from.address(), from.port(), monotonic_now())) {
    ++statistics_.refused_rate;
    return;
  }
  Bytes message;
  switch (link.session->open(*header, datagram.bytes, message)) {
    case DatagramVerdict::kForged:
      ++statistics_.refused_forged;
      return;
    case DatagramVerdict::kReplayed:
      ++statistics_.refused_replayed;
      return;
    case DatagramVerdict::kAccepted:
      break;
  }
  link.proven_source = from;
  const std::optional<Transport> channel = take_channel(message);
  if (!channel) {
    ++statistics_.refused_malformed;
    return;
  }
  deliver(link, *channel, std::move(message), datagram.at);
}

MessageId PeerNetwork::State::send_datagram(PeerId peer, Transport transport,
                                            const Bytes& message) {
  if (message.size() > kMaxDatagramMessage) {
    throw StreamError(StreamError::Kind::kNotUnderstood,
                      "found a datagram to a host that is too long, allowed: 65478 bytes");
  }
  const MessageId id = next_datagram_++;
  Link& to = link(peer);
  const bool known = to.datagrams_to.port() != 0 && !to.datagrams_to.address().is_unspecified();
  if (stopped_ || !to.session || !known) return id;
  datagrams_.send(id, to.session->seal_next(with_channel(transport, message)), to.datagrams_to);
  return id;
}

Task<std::optional<HostTime>> PeerNetwork::State::datagram_stamp(Self self, MessageId id,
                                                                 SteadyTime deadline) {
  if (self->stopped_) co_return std::nullopt;
  const auto left = co_await self->datagrams_.left(id, self->deadline_of(deadline));
  if (!left || self->stopped_) co_return std::nullopt;
  co_return self->clock_.system_at(*left);
}

PeerNetwork::PeerNetwork(boost::asio::io_context& context, PeerNetworkSettings settings,
                         NodeClock& clock)
    : state_(std::make_shared<State>(context, std::move(settings), clock)) {}

PeerNetwork::~PeerNetwork() { state_->stop(); }

void PeerNetwork::on_conductor(std::function<void(std::unique_ptr<SecureStream>)> handler) {
  state_->on_conductor(std::move(handler));
}

void PeerNetwork::start() { state_->start(); }

std::uint16_t PeerNetwork::port() const { return state_->port(); }

MessageChannel& PeerNetwork::channel(PeerId peer, Transport transport) {
  return state_->channel(peer, transport);
}

void PeerNetwork::clear() { state_->clear(); }

bool PeerNetwork::connected(PeerId peer) const { return state_->connected(peer); }

const NetworkStatistics& PeerNetwork::statistics() const { return state_->statistics(); }

}  // namespace simbench::hardware
