// What a Node is made of: its sockets and cameras, its conductors' connections, its session.
//
// Split over two files: node.cc has the life of the node (connections, the watch over a conductor's
// silence, the end), node_requests.cc what is done for each request. See node.h and protocol.h.
#ifndef SIMBENCH_HARDWARE_NODE_NODE_STATE_H_
#define SIMBENCH_HARDWARE_NODE_NODE_STATE_H_

#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "hardware/net/peer_network.h"
#include "hardware/node/camera_bench.h"
#include "hardware/node/conductor_connection.h"
#include "hardware/node/node.h"
#include "hardware/node/session.h"

namespace simbench::hardware {

class Node::State : public std::enable_shared_from_this<Node::State> {
 public:
  State(boost::asio::io_context& context, NodeSettings settings, NodeClock& clock,
        CameraDriver& cameras, HostSyncFactory make_host_sync, Log log);

  void start();
  void stop();
  void join() { cameras_.join(); }
  std::uint16_t port() const { return network_->port(); }

 private:
  using Connection = std::shared_ptr<ConductorConnection>;
  using Self = std::shared_ptr<State>;

  // node.cc
  void require_cameras();
  void accept(std::unique_ptr<SecureStream> stream);
  static Task<void> serve(Self self, Connection connection);
  static Task<void> watch(Self self, std::shared_ptr<Session> session);
  static Task<void> watch_refusals(Self self);
  static Task<void> end_everything(Self self);
  Task<void> end_session(std::shared_ptr<Session> session, std::string reason);
  void tell_conductors(const std::string& session, const std::string& notice,
                       const nlohmann::json& details);
  std::string refusals();

  // node_requests.cc
  Task<nlohmann::json> handle(Connection connection, Request request);
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
  HostSyncFactory make_host_sync_;
  Log log_;
  CameraBench cameras_;
  std::shared_ptr<PeerNetwork> network_;
  std::set<Connection> connections_;
  std::shared_ptr<Session> session_;
  MonotonicTime heard_{};  // of the session's conductor
  boost::asio::steady_timer silence_timer_;
  boost::asio::steady_timer refusal_timer_;
  NetworkStatistics told_;  // what refusals() has told of
  bool stopping_ = false;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NODE_NODE_STATE_H_
