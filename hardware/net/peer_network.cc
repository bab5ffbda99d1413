#include "hardware/net/peer_network.h"

#include <fmt/format.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/socket_base.hpp>

#include "algorithms/ports/assert.h"
#include "hardware/net/connect.h"
#include "hardware/net/peer_network_state.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::tcp;
using boost::asio::ip::udp;
using boost::system::error_code;

// Connections and datagrams of who has not proved the key, from one source.
constexpr double kConnectionsPerSecond = 100;
constexpr double kConnectionsAtOnce = 256;
constexpr double kStrangersPerSecond = 200;
constexpr double kStrangersAtOnce = 64;

// A flood must not crowd out what is waiting to be read.
constexpr int kDatagramBufferBytes = 1 << 20;

}  // namespace

class PeerNetwork::State::Channel final : public MessageChannel {
 public:
  Channel(State& state, PeerId peer, Transport transport)
      : state_(state), peer_(peer), transport_(transport) {}

  Task<MessageId> send(Bytes message) override {
    if (transport_ == Transport::kStream) {
      return send_by_stream(state_.shared_from_this(), peer_, std::move(message));
    }
    return send_at_once(state_.shared_from_this(), peer_, std::move(message));
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
  static Task<MessageId> send_at_once(Self self, PeerId peer, Bytes message) {
    co_return self->send_datagram(peer, message);
  }

  State& state_;
  PeerId peer_;
  Transport transport_;
};

PeerNetwork::State::Link::Link(State& state, PeerId of)
    : peer(of),
      stream_inbox(state.context_.get_executor()),
      datagram_inbox(state.context_.get_executor()),
      connected(state.context_.get_executor()),
      stream_channel(std::make_unique<Channel>(state, of, Transport::kStream)),
      datagram_channel(std::make_unique<Channel>(state, of, Transport::kDatagram)) {}

PeerNetwork::State::State(boost::asio::io_context& context, PeerNetworkSettings settings,
                          NodeClock& clock)
    : context_(context),
      settings_(std::move(settings)),
      clock_(clock),
      stopping_(context.get_executor()),
      acceptor_(context),
      connections_allowed_(kConnectionsPerSecond, kConnectionsAtOnce),
      datagrams_(context),
      strangers_allowed_(kStrangersPerSecond, kStrangersAtOnce),
      stamped_(context.get_executor()) {
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
  // Another program may have the datagram port of the number that is free for connections.
  for (int attempt = 0; attempt < 16; ++attempt) {
    acceptor_ = tcp::acceptor(context_);
    datagrams_ = udp::socket(context_);
    const tcp::endpoint wanted(address, settings_.listen.port);
    acceptor_.open(wanted.protocol(), error);
    if (!error) acceptor_.set_option(boost::asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(wanted, error);
    if (!error) acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
    if (!error) port_ = acceptor_.local_endpoint(error).port();
    const udp::endpoint beside(address, port_);
    if (!error) datagrams_.open(beside.protocol(), error);
    if (!error) datagrams_.bind(beside, error);
    if (!error || settings_.listen.port != 0) break;
  }
  if (error) {
    throw StreamError(
        StreamError::Kind::kUnreachable,
        fmt::format("{}: cannot listen there: {}; allowed: an address of this machine, and a port "
                    "that no other program (another simbench node?) has",
                    where, error.message()));
  }
  datagrams_.native_non_blocking(true, error);
  datagrams_.set_option(boost::asio::socket_base::receive_buffer_size(kDatagramBufferBytes), error);
  stamps_ = request_kernel_stamps(datagrams_.native_handle());
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
  datagrams_.close(ignored);
  for (Newcomer& newcomer : newcomers_) {
    newcomer.refuse.emit(boost::asio::cancellation_type::terminal);
  }
  for (const auto& link : links_) {
    if (!link) continue;
    if (link->stream) link->stream->close();
    link->stream_inbox.close();
    link->datagram_inbox.close();
    link->connected.notify();
  }
  stamped_.notify();
  stopping_.notify();
  on_conductor_ = nullptr;
}

PeerNetwork::State::Link& PeerNetwork::State::link(PeerId peer) {
  SIMBENCH_ASSERT(peer < links_.size() && links_[peer], "a channel to another host of the rig");
  return *links_[peer];
}

MessageChannel& PeerNetwork::State::channel(PeerId peer, Transport transport) {
  Link& with = link(peer);
  return transport == Transport::kStream ? *with.stream_channel : *with.datagram_channel;
}

void PeerNetwork::State::clear() {
  for (const auto& link : links_) {
    if (!link) continue;
    link->stream_inbox.clear();
    link->datagram_inbox.clear();
  }
}

bool PeerNetwork::State::connected(PeerId peer) const {
  return peer < links_.size() && links_[peer] && links_[peer]->stream;
}

// "For ever" has no instant on the oscillator's scale.
MonotonicTime PeerNetwork::State::deadline_of(SteadyTime deadline) const {
  constexpr Nanoseconds kForEver = std::chrono::hours(24 * 365 * 100);
  if (deadline.time_since_epoch() > kForEver) return MonotonicTime::max();
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
