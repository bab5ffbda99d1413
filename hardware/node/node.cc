#include "hardware/node/node.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hardware/net/notice.h"
#include "hardware/net/peer_network.h"
#include "hardware/node/camera_bench.h"
#include "hardware/node/conductor_connection.h"
#include "recording/version.h"

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

using nlohmann::json;

constexpr std::size_t kLongestName = 200;
// How long `begin` and `end` wait for a session that is ending.
constexpr Nanoseconds kEndWait = std::chrono::seconds(3);
constexpr Nanoseconds kEndPolls = std::chrono::milliseconds(10);

class RequestError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string text_argument(const json& arguments, const char* name) {
  const auto found = arguments.find(name);
  if (found == arguments.end() || !found->is_string()) {
    throw RequestError(fmt::format("'{}': found {}, allowed: a text", name,
                                   found == arguments.end() ? "nothing" : found->type_name()));
  }
  return found->get<std::string>();
}

std::string session_id_of(const json& arguments) {
  std::string id = text_argument(arguments, "session");
  if (!is_session_id(id)) throw RequestError("'session': allowed: 16 hexadecimal digits");
  return id;
}

// A short line for a log.
std::string name_of(const json& arguments) {
  std::string name = text_argument(arguments, "conductor").substr(0, kLongestName);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return name;
}

std::vector<PeerId> slaves_of(const json& arguments, std::size_t hosts) {
  std::vector<PeerId> slaves;
  if (!arguments.contains("slaves")) return slaves;
  for (const json& slave : arguments["slaves"]) {
    if (!slave.is_number_unsigned() || slave.get<std::uint64_t>() >= hosts) {
      throw RequestError(fmt::format("'slaves': allowed: numbers of hosts below {}", hosts));
    }
    slaves.push_back(slave.get<PeerId>());
  }
  return slaves;
}

json problems_of(const CameraProblems& problems) {
  json list = json::array();
  for (const CameraProblem& problem : problems) {
    list.push_back({{"camera", problem.camera}, {"text", problem.text}});
  }
  json result = json::object();
  result["problems"] = std::move(list);
  return result;
}

}  // namespace

// The inside of a Node: its sockets and cameras, its conductors' connections, its session.
class Node::State : public std::enable_shared_from_this<Node::State> {
 public:
  State(boost::asio::io_context& context, NodeSettings settings, NodeClock& clock,
        CameraDriver& cameras, PipelineFactory make_pipeline, Log log);

  void start();
  void stop();
  void join() { cameras_.join(); }
  std::uint16_t port() const { return network_->port(); }

 private:
  using Connection = std::shared_ptr<ConductorConnection>;
  using Self = std::shared_ptr<State>;

  // Connections, the watch over a silent conductor, the end.
  void require_cameras();
  void accept(std::unique_ptr<SecureStream> stream);
  static Task<void> serve(Self self, Connection connection);
  static Task<void> watch(Self self, std::shared_ptr<Session> session);
  static Task<void> watch_refusals(Self self);
  static Task<void> end_everything(Self self);
  Task<void> end_session(std::shared_ptr<Session> session, std::string reason);
  void notify_conductors(const std::string& session, const std::string& notice,
                         const nlohmann::json& details);
  std::string refusals();

  // The requests of a conductor (protocol.h).
  Task<nlohmann::json> handle(Connection connection, NodeRequest request);
  Task<nlohmann::json> hello();
  Task<nlohmann::json> begin(Connection connection, nlohmann::json arguments);
  Task<void> make_room(const Connection& connection);
  SessionPlan plan_of(const nlohmann::json& arguments) const;
  SessionWorld world(const std::string& session);
  Task<nlohmann::json> end(nlohmann::json arguments);
  nlohmann::json read(const nlohmann::json& arguments) const;
  std::shared_ptr<Session> session_of(const Connection& connection) const;

  const RigHost& host() const { return settings_.rig.hosts[settings_.me]; }

  boost::asio::io_context& context_;
  NodeSettings settings_;
  NodeClock& clock_;
  PipelineFactory make_pipeline_;
  Log log_;
  CameraBench cameras_;
  std::shared_ptr<PeerNetwork> network_;
  std::set<Connection> connections_;
  std::shared_ptr<Session> session_;
  MonotonicTime last_request_{};  // of the session's conductor
  boost::asio::steady_timer silence_timer_;
  boost::asio::steady_timer refusal_timer_;
  NetworkStatistics reported_;  // what refusals() has reported
  bool stopping_ = false;
};

Node::State::State(asio::io_context& context, NodeSettings settings, NodeClock& clock,
                   CameraDriver& cameras, PipelineFactory make_pipeline, Log log)
    : context_(context),
      settings_(std::move(settings)),
      clock_(clock),
      make_pipeline_(std::move(make_pipeline)),
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
      [state = weak_from_this()](Connection from, NodeRequest request) -> Task<nlohmann::json> {
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
    const MonotonicTime deadline = self->last_request_ + self->settings_.conductor_silence;
    if (monotonic_now() >= deadline) {
      co_await self->end_session(session,
                                 fmt::format("no request from its conductor for {:.3g} s",
                                             to_seconds(self->settings_.conductor_silence)));
      co_return;
    }
    self->silence_timer_.expires_at(for_timer(deadline));
    co_await ended(self->silence_timer_);
  }
}

Task<void> Node::State::end_session(std::shared_ptr<Session> session, std::string reason) {
  silence_timer_.cancel();
  co_await session->end(std::move(reason));
  if (session_ == session) session_.reset();
}

void Node::State::notify_conductors(const std::string& session, const std::string& notice,
                                    const nlohmann::json& details) {
  for (const Connection& connection : connections_) {
    if (connection->session() == session) connection->notify(notice, details);
  }
}

Task<void> Node::State::watch_refusals(Self self) {
  while (!self->stopping_) {
    self->refusal_timer_.expires_after(kRefusalInterval);
    co_await ended(self->refusal_timer_);
    const std::string refused = self->stopping_ ? "" : self->refusals();
    if (!refused.empty()) self->log_("refused in the last 10 s: " + refused);
  }
}

std::string Node::State::refusals() {
  const NetworkStatistics now = network_->statistics();
  std::vector<std::string> parts;
  const auto add = [&](std::uint64_t count, std::uint64_t reported, const char* what) {
    if (count > reported) parts.push_back(fmt::format("{} {}", count - reported, what));
  };
  add(now.refused_connections, reported_.refused_connections, "connections");
  add(now.refused_forged, reported_.refused_forged, "forged messages");
  add(now.refused_replayed, reported_.refused_replayed, "replayed messages");
  add(now.refused_malformed, reported_.refused_malformed, "malformed messages");
  add(now.refused_rate, reported_.refused_rate, "messages beyond the rate");
  add(now.dropped_full_queue, reported_.dropped_full_queue, "messages beyond a full queue");
  reported_ = now;
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

Task<json> Node::State::handle(Connection connection, NodeRequest request) {
  const Self self = shared_from_this();
  const json& arguments = request.arguments;
  // A conductor that fetches a journal goes on with the node that replaces this one.
  const bool asks_only = request.verb == "read" || request.verb == "ping";
  if (stopping_ && !asks_only) throw RequestError("the node is ending");
  if (session_ && request.verb != "begin" && arguments.contains("session") &&
      arguments["session"] == session_->id()) {
    connection->join(session_->id());
  }
  if (session_ && connection->session() == session_->id()) last_request_ = monotonic_now();
  if (request.verb == "ping") co_return json::object();
  if (request.verb == "hello") co_return co_await hello();
  if (request.verb == "begin") co_return co_await begin(connection, arguments);
  if (request.verb == "read") co_return read(arguments);
  if (request.verb == "end") co_return co_await end(arguments);
  const std::shared_ptr<Session> session = session_of(connection);
  CameraProblems problems;
  if (request.verb == "synchronise") {
    session->synchronise(text_argument(arguments, "role"),
                         slaves_of(arguments, settings_.rig.hosts.size()));
    co_return json::object();
  }
  if (request.verb == "prepare") {
    problems = co_await session->prepare();
  } else if (request.verb == "start") {
    problems = co_await session->start();
  } else if (request.verb == "stop") {
    problems = co_await session->stop();
  } else {
    throw RequestError(fmt::format(
        "'do': found '{}', allowed: hello, begin, synchronise, prepare, start, stop, read, end, "
        "ping",
        request.verb.substr(0, kLongestName)));
  }
  co_return problems_of(problems);
}

std::shared_ptr<Session> Node::State::session_of(const Connection& connection) const {
  if (!session_ || connection->session() != session_->id()) {
    throw RequestError("no session over this connection: begin one, or name the running one");
  }
  return session_;
}

Task<json> Node::State::hello() {
  const std::vector<CameraState> states = co_await cameras_.look_again();
  json cameras = json::array();
  for (const CameraState& camera : states) {
    cameras.push_back({{"serial", camera.info.serial},
                       {"model", camera.info.model},
                       {"firmware", camera.info.firmware},
                       {"connection", camera.info.connection},
                       {"problem", camera.problem}});
  }
  const NodeOscillator& oscillator = clock_.oscillator();
  json clock = {{"kind", settings_.clock_kind},
                {"monotonic_zero_ns", nanoseconds_of(oscillator.monotonic_zero)},
                {"steady_zero_ns", nanoseconds_of(oscillator.steady_zero)},
                {"skew_ppm", oscillator.skew_ppm}};
  json result = {{"version", version()}, {"commit", commit()}, {"name", host().name}};
  result["clock"] = std::move(clock);
  result["cameras"] = std::move(cameras);
  result["session"] = session_ ? json(session_->id()) : json(nullptr);
  co_return result;
}

// Waits until there is no session. Throws if another conductor has one.
Task<void> Node::State::make_room(const Connection& connection) {
  const MonotonicTime deadline = monotonic_now() + kEndWait;
  while (session_) {
    const std::shared_ptr<Session> session = session_;
    if (session->ending() && monotonic_now() < deadline) {
      co_await pause(context_.get_executor(), kEndPolls);
    } else if (connection->session() == session->id() && !session->ending()) {
      co_await end_session(session, "its conductor begins another");
    } else {
      throw RequestError(fmt::format("busy: conducted by {} since {} (session {})",
                                     session->conductor(), session->since(), session->id()));
    }
  }
}

Task<json> Node::State::begin(Connection connection, json arguments) {
  SessionPlan plan = plan_of(arguments);
  co_await make_room(connection);
  const std::string id = plan.id;
  session_ = std::make_shared<Session>(world(id), std::move(plan));
  connection->join(id);
  last_request_ = monotonic_now();
  asio::co_spawn(context_, watch(shared_from_this(), session_), asio::detached);
  co_return json::object();
}

SessionPlan Node::State::plan_of(const json& arguments) const {
  SessionPlan plan;
  plan.id = session_id_of(arguments);
  plan.conductor = name_of(arguments);
  plan.pipeline = text_argument(arguments, "pipeline");
  const std::string text = text_argument(arguments, "scenario");
  const json parsed = json::parse(text, nullptr, false);
  if (parsed.is_object() && parsed.contains("base")) {
    throw RequestError("'scenario': found one with a base, allowed: a resolved scenario");
  }
  plan.scenario = scenarios::load_scenario_text(text, "scenario");
  check_rig_fits(settings_.rig, plan.scenario);
  try {
    plan.algorithms = make_pipeline_(plan.scenario, plan.pipeline);
  } catch (const scenarios::InputError& error) {
    throw RequestError(
        fmt::format("{} (this node: simbench {}, commit {})", error.what(), version(), commit()));
  }
  return plan;
}

SessionWorld Node::State::world(const std::string& session) {
  return {.context = context_,
          .clock = clock_,
          .network = network_,
          .cameras = cameras_,
          .me = settings_.me,
          .hosts = static_cast<PeerId>(settings_.rig.hosts.size()),
          .host_name = host().name,
          .journal_folder = settings_.journal_folder,
          .notify =
              [state = weak_from_this(), session](const std::string& notice, const json& details) {
                if (const Self self = state.lock())
                  self->notify_conductors(session, notice, details);
              },
          .log = log_};
}

// Ends the session, or finds that it has ended by itself.
Task<json> Node::State::end(json arguments) {
  const std::string id = session_id_of(arguments);
  const std::shared_ptr<Session> session = session_;
  if (session && session->id() == id && !session->ending()) {
    co_await end_session(session, "on request");
  }
  const MonotonicTime deadline = monotonic_now() + kEndWait;
  while (session_ && session_->id() == id && monotonic_now() < deadline) {
    co_await pause(context_.get_executor(), kEndPolls);
  }
  if (!read_journal(settings_.journal_folder, id, 0)) {
    throw RequestError(fmt::format("session {}: there is none of that id here", id));
  }
  co_return json::object();
}

json Node::State::read(const json& arguments) const {
  const std::string id = session_id_of(arguments);
  const auto offset = arguments.find("offset");
  if (offset == arguments.end() || !offset->is_number_unsigned()) {
    throw RequestError("'offset': allowed: a whole number");
  }
  const auto chunk = read_journal(settings_.journal_folder, id, offset->get<std::uint64_t>());
  if (!chunk)
    throw RequestError(fmt::format("session {}: {} has no journal of it", id, host().name));
  return {{"text", chunk->text},
          {"size", chunk->size},
          {"closed", !(session_ && session_->id() == id)}};
}

Node::Node(asio::io_context& context, NodeSettings settings, NodeClock& clock,
           CameraDriver& cameras, PipelineFactory make_pipeline, Log log)
    : state_(std::make_shared<State>(context, std::move(settings), clock, cameras,
                                     std::move(make_pipeline), std::move(log))) {}
Node::~Node() {
  state_->stop();
  state_->join();
}

void Node::start() { state_->start(); }
std::uint16_t Node::port() const { return state_->port(); }
void Node::stop() { state_->stop(); }

}  // namespace simbench::hardware
