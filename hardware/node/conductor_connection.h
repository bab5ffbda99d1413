// A conductor's connection on the node's side: requests in, replies and notices out.
//
// Contract
//  - Requests are bounded: kMaxRequestBytes each, kRequestsPerSecond (further ones wait, and so
//    does their sender), kWaitingRequests behind a slow one.
//  - A message that is no request ends this connection alone.
//  - Read, synchronise and ping are answered at once, all others one after the other.
//  - An exception of the handler becomes the reply's error.
//
// One thread. Held by a shared_ptr.
//
//   auto connection = std::make_shared<ConductorConnection>(context, std::move(stream), handler);
//   co_await connection->serve();    // returns why it ended
#pragma once

#include <boost/asio/io_context.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "hardware/net/secure_stream.h"
#include "hardware/net/token_bucket.h"
#include "hardware/node/protocol.h"

namespace simbench::hardware {

inline constexpr std::size_t kMaxRequestBytes = 1u << 20;
inline constexpr double kRequestsPerSecond = 500;
inline constexpr std::size_t kWaitingRequests = 32;
// A connection without a message for so long is closed.
inline constexpr Nanoseconds kIdleConnection = std::chrono::minutes(1);

class ConductorConnection : public std::enable_shared_from_this<ConductorConnection> {
 public:
  using Handler =
      std::function<Task<nlohmann::json>(std::shared_ptr<ConductorConnection>, NodeRequest)>;

  ConductorConnection(boost::asio::io_context& context, std::unique_ptr<SecureStream> stream,
                      Handler handler);

  Task<std::string> serve();
  void notify(const std::string& notice, const nlohmann::json& details);
  void close() { stream_->close(); }

  std::string address() const { return stream_->peer_address(); }
  // The session to which it belongs; empty: none.
  const std::string& session() const { return session_; }
  void join(const std::string& session) { session_ = session; }

 private:
  Task<void> take(NodeRequest request);
  Task<void> throttle();
  Task<void> answer(NodeRequest request);

  using Self = std::shared_ptr<ConductorConnection>;
  static Task<void> answer_waiting(Self self);
  static Task<void> send(Self self, NodeAnswer answer);

  boost::asio::io_context& context_;
  std::unique_ptr<SecureStream> stream_;
  Handler handler_;
  std::string session_;
  std::deque<NodeRequest> waiting_;
  bool answering_ = false;
  TokenBucket allowance_;
};

}  // namespace simbench::hardware
