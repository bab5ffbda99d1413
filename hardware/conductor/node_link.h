// The conductor's connection to one node: requests with replies, over a stream that is reopened
// when it breaks.
//
// Contract
//  - ask() sends a request and waits for its reply, opening the stream first if there is none. It
//    never waits longer than its limit, however often the stream breaks. A request whose stream
//    broke is not sent again.
//  - The node's notices go to the handler as they arrive.
//  - Any number of requests may be pending. One thread.
//
// Errors: NodeError, one line that begins with the host's name and address. kRefused is the node's
// own answer; every other kind means that the request did not reach it or got no answer.
//
//   NodeLink link(context, rig.hosts[3], key, [](const NodeAnswer& notice) { ... });
//   nlohmann::json hello = co_await link.ask("hello", {}, std::chrono::seconds(3));
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "algorithms/ports/host.h"
#include "hardware/net/secret_key.h"
#include "hardware/node/protocol.h"
#include "hardware/rig/rig.h"

namespace simbench::hardware {

class NodeError : public std::runtime_error {
 public:
  enum class Kind : std::uint8_t {
    kRefused,  // the node refused the request
    kLost,     // it cannot be reached, or did not answer in time
    kForeign,  // another key, another version, or no node: do not try again
  };
  NodeError(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

class NodeLink {
 public:
  using NoticeHandler = std::function<void(const NodeAnswer& notice)>;

  NodeLink(boost::asio::io_context& context, const RigHost& host, SecretKey key,
           NoticeHandler on_notice);
  ~NodeLink();
  NodeLink(NodeLink&&) noexcept;
  NodeLink& operator=(NodeLink&&) = delete;

  // The result of the reply.
  Task<nlohmann::json> ask(std::string verb, nlohmann::json arguments, Nanoseconds limit);
  void close();

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace simbench::hardware
