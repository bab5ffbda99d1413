// What a node does for each request of a conductor.
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>
#include <vector>

#include "hardware/node/node_state.h"
#include "recording/version.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;
using nlohmann::json;

constexpr std::size_t kLongestName = 200;
// How long a begin waits for the end of a session that is ending.
constexpr Nanoseconds kEndWait = std::chrono::seconds(3);

class RequestError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string text_of(const json& arguments, const char* name) {
  const auto found = arguments.find(name);
  if (found == arguments.end() || !found->is_string()) {
    throw RequestError(fmt::format("'{}': found {}, allowed: a text", name,
                                   found == arguments.end() ? "nothing" : found->type_name()));
  }
  return found->get<std::string>();
}

std::string session_of(const json& arguments) {
  std::string id = text_of(arguments, "session");
  if (!is_session_id(id)) throw RequestError("'session': allowed: 16 hexadecimal digits");
  return id;
}

// For a log: one line, and not a long one.
std::string name_of(const json& arguments) {
  std::string name = text_of(arguments, "conductor").substr(0, kLongestName);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return name;
}

std::string optional_text(const json& arguments, const char* name) {
  return arguments.contains(name) ? text_of(arguments, name).substr(0, kLongestName) : "";
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

Task<json> Node::State::handle(Connection connection, Request request) {
  const Self self = shared_from_this();
  const json& arguments = request.arguments;
  // Who fetches what was recorded goes on with the node that comes after this one.
  const bool asks_only = request.verb == "read" || request.verb == "ping";
  if (stopping_ && !asks_only) throw RequestError("the node is ending");
  if (session_ && request.verb != "begin" && arguments.contains("session") &&
      arguments["session"] == session_->id()) {
    connection->join(session_->id());
  }
  if (session_ && connection->session() == session_->id()) heard_ = monotonic_now();
  if (request.verb == "ping") co_return json::object();
  if (request.verb == "hello") co_return co_await hello();
  if (request.verb == "begin") co_return co_await begin(connection, arguments);
  if (request.verb == "read") co_return read(arguments);
  if (request.verb == "end") co_return co_await end(arguments);
  const std::shared_ptr<Session> session = session_of(connection);
  CameraProblems problems;
  if (request.verb == "synchronise") {
    session->synchronise(text_of(arguments, "role"),
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
    throw RequestError("no session over this connection: begin one, or name the one that lives");
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

// Until there is no session. Throws if another conductor's lives.
Task<void> Node::State::make_room(const Connection& connection) {
  const MonotonicTime deadline = monotonic_now() + kEndWait;
  while (session_) {
    const std::shared_ptr<Session> session = session_;
    if (session->ending() && monotonic_now() < deadline) {
      asio::steady_timer timer(context_, std::chrono::milliseconds(10));
      boost::system::error_code ignored;
      co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
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
  heard_ = monotonic_now();
  asio::co_spawn(context_, watch(shared_from_this(), session_), asio::detached);
  co_return json::object();
}

SessionPlan Node::State::plan_of(const json& arguments) const {
  SessionPlan plan;
  plan.id = ::simbench::hardware::session_of(arguments);
  plan.conductor = name_of(arguments);
  plan.pipeline = text_of(arguments, "pipeline");
  const std::string text = text_of(arguments, "scenario");
  const json parsed = json::parse(text, nullptr, false);
  if (parsed.is_object() && parsed.contains("base")) {
    throw RequestError("'scenario': found one with a base, allowed: a resolved scenario");
  }
  plan.scenario = scenarios::load_scenario_text(text, "scenario");
  check_rig_fits(settings_.rig, plan.scenario);
  try {
    plan.host_sync = make_host_sync_(plan.scenario, plan.pipeline);
  } catch (const scenarios::InputError& error) {
    const std::string theirs = optional_text(arguments, "version");
    throw RequestError(
        fmt::format("{} (this node: simbench {}, commit {}{})", error.what(), version(), commit(),
                    theirs.empty() ? ""
                                   : fmt::format("; the conductor: simbench {}, commit {}", theirs,
                                                 optional_text(arguments, "commit"))));
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
                if (const Self self = state.lock()) self->tell_conductors(session, notice, details);
              },
          .log = log_};
}

// Also of a session that has ended by itself: that is what was asked for.
Task<json> Node::State::end(json arguments) {
  const std::string id = ::simbench::hardware::session_of(arguments);
  const std::shared_ptr<Session> session = session_;
  if (session && session->id() == id && !session->ending()) {
    co_await end_session(session, "asked for");
  }
  const MonotonicTime deadline = monotonic_now() + kEndWait;
  while (session_ && session_->id() == id && monotonic_now() < deadline) {
    asio::steady_timer timer(context_, std::chrono::milliseconds(10));
    boost::system::error_code ignored;
    co_await timer.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  }
  if (!read_journal(settings_.journal_folder, id, 0)) {
    throw RequestError(fmt::format("session {}: there is none of that id here", id));
  }
  co_return json::object();
}

json Node::State::read(const json& arguments) const {
  const std::string id = ::simbench::hardware::session_of(arguments);
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

}  // namespace simbench::hardware
