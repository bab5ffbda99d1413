#include "hardware/node/node.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>
#include <vector>

#include "hardware/node/node_state.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;

constexpr std::size_t kMaxConnections = 16;
constexpr auto kRefusalInterval = std::chrono::seconds(10);

PeerNetworkSettings network_settings(const NodeSettings& settings) {
  std::vector<PeerAddress> peers;
  for (const RigHost& host : settings.rig.hosts) peers.push_back({host.address, host.port});
  const PeerAddress listen = peers.at(settings.me);
  return {.me = settings.me, .listen = listen, .peers = std::move(peers), .key = settings.key};
}

std::vector<CameraPlace> places(const NodeSettings& settings) {
  std::vector<CameraPlace> places;
  std::uint32_t number = 0;
  for (PeerId host = 0; host <= settings.me; ++host) {
    for (const RigCamera& camera : settings.rig.hosts.at(host).cameras) {
      if (host == settings.me) places.push_back({camera.serial, number});
      ++number;
    }
  }
  return places;
}

}  // namespace

Node::State::State(asio::io_context& context, NodeSettings settings, NodeClock& clock,
                   CameraDriver& cameras, HostSyncFactory make_host_sync, Log log)
    : context_(context),
      settings_(std::move(settings)),
      clock_(clock),
      make_host_sync_(std::move(make_host_sync)),
      log_(std::move(log)),
      cameras_(cameras, places(settings_)),
      silence_timer_(context),
      refusal_timer_(context) {
  check_rig_is_guarded(settings_.rig, settings_.key.is_secret());
  make_journal_folder(settings_.journal_folder);
  require_cameras();
  network_ = std::make_shared<PeerNetwork>(context, network_settings(settings_), clock);
}

void Node::State::require_cameras() {
  for (const CameraState& camera : cameras_.look()) {
    if (camera.problem.empty()) continue;
    throw CameraError(
        fmt::format("{}: camera {}: {}", host().name, camera.info.serial, camera.problem));
  }
}

void Node::State::start() {
  network_->on_conductor([state = weak_from_this()](std::unique_ptr<SecureStream> stream) {
    if (const Self self = state.lock()) self->accept(std::move(stream));
  });
  network_->start();
  asio::co_spawn(context_, watch_refusals(shared_from_this()), asio::detached);
}

void Node::State::accept(std::unique_ptr<SecureStream> stream) {
  if (stopping_) return;
  if (connections_.size() >= kMaxConnections) {
    log_(fmt::format("{}: refused: {} conductors are connected already", stream->peer_address(),
                     kMaxConnections));
    return;
  }
  const auto connection = std::make_shared<ConductorConnection>(
      context_, std::move(stream),
      [state = weak_from_this()](Connection from, Request request) -> Task<nlohmann::json> {
        const Self self = state.lock();
        if (!self) throw SessionError("the node is ending");
        return self->handle(std::move(from), std::move(request));
      });
  connections_.insert(connection);
  asio::co_spawn(context_, serve(shared_from_this(), connection), asio::detached);
}

Task<void> Node::State::serve(Self self, Connection connection) {
  const std::string why = co_await connection->serve();
  self->connections_.erase(connection);
  const bool conducts = self->session_ && self->session_->id() == connection->session();
  if (conducts && !self->session_->ending()) {
    self->log_(fmt::format("{}: connection of session {} lost: {}", connection->address(),
                           connection->session(), why));
  }
}

Task<void> Node::State::watch(Self self, std::shared_ptr<Session> session) {
  while (!session->ending()) {
    const MonotonicTime deadline = self->heard_ + self->settings_.conductor_silence;
    if (monotonic_now() >= deadline) {
      co_await self->end_session(session,
                                 fmt::format("nothing heard from its conductor for {:.3g} s",
                                             to_seconds(self->settings_.conductor_silence)));
      co_return;
    }
    self->silence_timer_.expires_at(for_timer(deadline));
    boost::system::error_code ignored;
    co_await self->silence_timer_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  }
}

Task<void> Node::State::end_session(std::shared_ptr<Session> session, std::string reason) {
  silence_timer_.cancel();
  co_await session->end(std::move(reason));
  if (session_ == session) session_.reset();
}

void Node::State::tell_conductors(const std::string& session, const std::string& notice,
                                  const nlohmann::json& details) {
  for (const Connection& connection : connections_) {
    if (connection->session() == session) connection->tell(notice, details);
  }
}

Task<void> Node::State::watch_refusals(Self self) {
  while (!self->stopping_) {
    self->refusal_timer_.expires_after(kRefusalInterval);
    boost::system::error_code ignored;
    co_await self->refusal_timer_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
    const std::string refused = self->stopping_ ? "" : self->refusals();
    if (!refused.empty()) self->log_("refused in the last 10 s: " + refused);
  }
}

std::string Node::State::refusals() {
  const NetworkStatistics now = network_->statistics();
  std::vector<std::string> parts;
  const auto add = [&](std::uint64_t count, std::uint64_t told, const char* what) {
    if (count > told) parts.push_back(fmt::format("{} {}", count - told, what));
  };
  add(now.refused_connections, told_.refused_connections, "connections");
  add(now.refused_forged, told_.refused_forged, "forged messages");
  add(now.refused_replayed, told_.refused_replayed, "replayed messages");
  add(now.refused_malformed, told_.refused_malformed, "malformed messages");
  add(now.refused_rate, told_.refused_rate, "messages beyond the rate");
  add(now.dropped_full_queue, told_.dropped_full_queue, "messages that nobody took");
  told_ = now;
  return fmt::format("{}", fmt::join(parts, ", "));
}

void Node::State::stop() {
  if (std::exchange(stopping_, true)) return;
  refusal_timer_.cancel();
  asio::co_spawn(context_, end_everything(shared_from_this()), asio::detached);
}

Task<void> Node::State::end_everything(Self self) {
  const std::shared_ptr<Session> session = self->session_;
  if (session) co_await self->end_session(session, "the node is stopped");
  for (const Connection& connection : self->connections_) connection->close();
  self->network_.reset();
}

Node::Node(asio::io_context& context, NodeSettings settings, NodeClock& clock,
           CameraDriver& cameras, HostSyncFactory make_host_sync, Log log)
    : state_(std::make_shared<State>(context, std::move(settings), clock, cameras,
                                     std::move(make_host_sync), std::move(log))) {}
Node::~Node() {
  state_->stop();
  state_->join();
}

void Node::start() { state_->start(); }
std::uint16_t Node::port() const { return state_->port(); }
void Node::stop() { state_->stop(); }

}  // namespace simbench::hardware
