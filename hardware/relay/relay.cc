#include "hardware/relay/relay.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <utility>

#include "hardware/net/connect.h"
#include "hardware/net/kernel_stamps.h"
#include "hardware/net/notice.h"
#include "hardware/net/token_bucket.h"
#include "hardware/relay/delay_queue.h"
#include "hardware/relay/relayed_stream.h"
#include "hardware/relay/wires.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::tcp;
using boost::asio::ip::udp;
using Error = boost::system::error_code;

constexpr std::size_t kLargestDatagram = 65536;
constexpr Nanoseconds kPauseAfterError = std::chrono::milliseconds(10);

// Loopback, or a private address of RFC 1918.
bool is_private(const boost::asio::ip::address& address) {
  if (address.is_loopback()) return true;
  if (!address.is_v4()) return false;
  const std::uint32_t bits = address.to_v4().to_uint();
  return bits >> 24 == 10 || bits >> 20 == 0xac1 || bits >> 16 == 0xc0a8;
}

boost::asio::ip::address host_address(const Rig& rig, const RigHost& host) {
  Error error;
  auto address = boost::asio::ip::make_address(host.address, error);
  if (error || !is_private(address)) {
    throw RelayError(fmt::format(
        "{}: host '{}': found address '{}', allowed for a relay: a numeric loopback or private one",
        rig.file, host.name, host.address));
  }
  return address;
}

// Where node `from` reaches node `to`: the relay's sockets in its place.
struct Gate {
  Gate(boost::asio::io_context& context, NetworkLaw its_law)
      : acceptor(context), socket(context), law(std::move(its_law)) {}

  PeerId from = 0;
  PeerId to = 0;
  tcp::acceptor acceptor;
  udp::socket socket;
  NetworkLaw law;  // of what comes from `from`
  TokenBucket bucket;
  std::weak_ptr<RelayedStream> stream;
};

void bind(Gate& gate, const Rig& rig, const RigHost& host) {
  try {
    const tcp::endpoint endpoint(host_address(rig, host), host.port);
    gate.acceptor.open(endpoint.protocol());
    gate.acceptor.set_option(tcp::acceptor::reuse_address(true));
    gate.acceptor.bind(endpoint);
    gate.acceptor.listen();
    const udp::endpoint datagrams(endpoint.address(), endpoint.port());
    gate.socket.open(datagrams.protocol());
    gate.socket.bind(datagrams);
    gate.socket.non_blocking(true);
    request_receive_stamps(gate.socket.native_handle());
  } catch (const boost::system::system_error& error) {
    throw RelayError(fmt::format("{}: host '{}': cannot listen on {}: {}", rig.file, host.name,
                                 address_text(host.address, host.port), error.code().message()));
  }
}

}  // namespace

class Relay::State : public std::enable_shared_from_this<Relay::State> {
 public:
  State(boost::asio::io_context& context, const RelaySettings& settings)
      : context_(context), queue_(context) {
    const std::size_t count = settings.nodes.size();
    for (PeerId node = 0; node < count; ++node) {
      const Rig& rig = settings.nodes[node];
      if (rig.hosts.size() != count) {
        throw RelayError(fmt::format("{}: found {} hosts, allowed: {}, one for each of the files",
                                     rig.file, rig.hosts.size(), count));
      }
      nodes_.emplace_back(host_address(rig, rig.hosts[node]), rig.hosts[node].port);
    }
    if (!settings.wires.empty()) {
      const Wires::Settings wires{
          .wires = settings.wires, .scenario = settings.scenario, .seed = settings.seed};
      wires_ = std::make_unique<Wires>(context, queue_, wires);
    }
    for (PeerId from = 0; from < count; ++from) {
      for (PeerId to = 0; to < count; ++to) {
        auto gate = std::make_unique<Gate>(
            context, NetworkLaw(settings.scenario->network, settings.seed, from, to));
        gate->from = from;
        gate->to = to;
        const Rig& rig = settings.nodes[from];
        if (from != to) bind(*gate, rig, rig.hosts[to]);
        gates_.push_back(std::move(gate));
      }
    }
  }

  void start() {
    for (const auto& gate : gates_) {
      if (gate->from == gate->to) continue;
      boost::asio::co_spawn(context_, accept(shared_from_this(), *gate), boost::asio::detached);
      boost::asio::co_spawn(context_, receive(shared_from_this(), *gate), boost::asio::detached);
    }
  }

  void stop() {
    queue_.stop();
    if (wires_) wires_->stop();
    Error ignored;
    for (const auto& gate : gates_) {
      gate->acceptor.close(ignored);
      gate->socket.close(ignored);
      if (const auto stream = gate->stream.lock()) stream->close();
    }
  }

  RelayStatistics statistics() const {
    RelayStatistics all = statistics_;
    if (wires_) {
      all.law = wires_->counts();
      all.dropped_full += wires_->dropped();
    }
    for (const auto& gate : gates_) all.law += gate->law.counts();
    all.late_p50 = queue_.lateness(0.5);
    all.late_p95 = queue_.lateness(0.95);
    return all;
  }

 private:
  Gate& gate(PeerId from, PeerId to) { return *gates_[from * nodes_.size() + to]; }

  // `gate` is a member of `self`; so in receive().
  static Task<void> accept(std::shared_ptr<State> self, Gate& gate) {
    while (gate.acceptor.is_open()) {
      tcp::socket socket(self->context_);
      Error error;
      co_await gate.acceptor.async_accept(
          socket, boost::asio::redirect_error(boost::asio::use_awaitable, error));
      if (!gate.acceptor.is_open()) co_return;
      if (error) {
        co_await pause(self->context_.get_executor(), kPauseAfterError);
        continue;
      }
      if (const auto last = gate.stream.lock()) last->close();
      const auto stream = std::make_shared<RelayedStream>(
          self->queue_, gate.law, self->gate(gate.to, gate.from).law, std::move(socket));
      gate.stream = stream;
      ++self->statistics_.streams;
      stream->start(self->nodes_[gate.to], [self] { ++self->statistics_.broken_streams; });
    }
  }

  static Task<void> receive(std::shared_ptr<State> self, Gate& gate) {
    Bytes buffer(kLargestDatagram);
    while (gate.socket.is_open()) {
      const ReceivedPiece piece = receive_stamped(gate.socket.native_handle(), buffer, nullptr);
      if (piece.error == 0) {
        if (!piece.truncated) self->relay(gate, piece, buffer);
      } else if (piece.error != EAGAIN && piece.error != EWOULDBLOCK) {
        // Such as "connection refused" for an earlier datagram, which the socket reports once.
        continue;
      }
      Error error;
      co_await gate.socket.async_wait(
          udp::socket::wait_read, boost::asio::redirect_error(boost::asio::use_awaitable, error));
    }
  }

  void relay(Gate& gate, const ReceivedPiece& piece, const Bytes& buffer) {
    if (!gate.bucket.take(monotonic_now(), kMaxDatagramsPerSecond, kMaxDatagramsPerSecond)) {
      ++statistics_.dropped_rate;
      return;
    }
    for (const MonotonicTime at : gate.law.datagram(piece.received)) {
      Bytes message(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(piece.bytes));
      const bool taken = queue_.add(
          at, message,
          [self = shared_from_this(), &gate](const Bytes& due) { self->send(gate, due); });
      if (!taken) ++statistics_.dropped_full;
    }
  }

  void send(Gate& gate, const Bytes& message) {
    const tcp::endpoint& node = nodes_[gate.to];
    Error ignored;
    this->gate(gate.to, gate.from)
        .socket.send_to(boost::asio::buffer(message), udp::endpoint(node.address(), node.port()), 0,
                        ignored);
  }

  boost::asio::io_context& context_;
  DelayQueue queue_;
  std::vector<tcp::endpoint> nodes_;
  std::vector<std::unique_ptr<Gate>> gates_;  // [from * nodes + to]; none listens from == to
  std::unique_ptr<Wires> wires_;              // of programs; null without them
  RelayStatistics statistics_;
};

Relay::Relay(boost::asio::io_context& context, const RelaySettings& settings)
    : state_(std::make_shared<State>(context, settings)) {
  state_->start();
}

Relay::~Relay() { stop(); }

void Relay::stop() { state_->stop(); }

RelayStatistics Relay::statistics() const { return state_->statistics(); }

std::string statistics_json(const RelayStatistics& statistics) {
  const auto microseconds = [](std::optional<Nanoseconds> late) {
    return late ? nlohmann::ordered_json(static_cast<double>(late->count()) * 1e-3)
                : nlohmann::ordered_json(nullptr);
  };
  return nlohmann::ordered_json{{"datagrams", statistics.law.datagrams},
                                {"lost", statistics.law.lost},
                                {"duplicated", statistics.law.duplicated},
                                {"reordered", statistics.law.reordered},
                                {"stream_messages", statistics.law.stream_messages},
                                {"retransmissions", statistics.law.retransmissions},
                                {"dropped_full", statistics.dropped_full},
                                {"dropped_rate", statistics.dropped_rate},
                                {"streams", statistics.streams},
                                {"broken_streams", statistics.broken_streams},
                                {"late_p50_us", microseconds(statistics.late_p50)},
                                {"late_p95_us", microseconds(statistics.late_p95)}}
      .dump();
}

}  // namespace simbench::hardware
