#include "hardware/node/conductor_connection.h"

#include <fmt/format.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <exception>
#include <utility>

#include "hardware/net/notice.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;

bool is_quick(const std::string& verb) {
  return verb == "read" || verb == "ping" || verb == "synchronise";
}

}  // namespace

ConductorConnection::ConductorConnection(asio::io_context& context,
                                         std::unique_ptr<SecureStream> stream, Handler handler)
    : context_(context), stream_(std::move(stream)), handler_(std::move(handler)) {}

Task<std::string> ConductorConnection::serve() {
  const auto self = shared_from_this();
  std::string why;
  while (why.empty()) {
    try {
      const StreamMessage message = co_await stream_->receive(monotonic_now() + kIdleConnection);
      if (message.bytes.size() > kMaxRequestBytes) {
        throw ProtocolError(fmt::format("a request of {} bytes, allowed: {}", message.bytes.size(),
                                        kMaxRequestBytes));
      }
      NodeRequest request = parse_request(message.bytes);
      co_await throttle();
      co_await take(std::move(request));
    } catch (const std::exception& error) {
      why = error.what();
    }
  }
  stream_->close();
  co_return why;
}

Task<void> ConductorConnection::take(NodeRequest request) {
  if (is_quick(request.verb)) {
    co_await answer(std::move(request));
    co_return;
  }
  if (waiting_.size() >= kWaitingRequests) {
    throw ProtocolError(fmt::format("more than {} requests at a time", kWaitingRequests));
  }
  waiting_.push_back(std::move(request));
  if (std::exchange(answering_, true)) co_return;
  asio::co_spawn(context_, answer_waiting(shared_from_this()), asio::detached);
}

Task<void> ConductorConnection::answer_waiting(Self self) {
  while (!self->waiting_.empty()) {
    NodeRequest request = std::move(self->waiting_.front());
    self->waiting_.pop_front();
    co_await self->answer(std::move(request));
  }
  self->answering_ = false;
}

Task<void> ConductorConnection::throttle() {
  while (!allowance_.take(monotonic_now(), kRequestsPerSecond, kRequestsPerSecond)) {
    co_await pause(context_.get_executor(), from_ms(1000 / kRequestsPerSecond));
  }
}

Task<void> ConductorConnection::answer(NodeRequest request) {
  NodeAnswer reply;
  reply.id = request.id;
  try {
    reply.details = co_await handler_(shared_from_this(), std::move(request));
  } catch (const std::exception& error) {
    reply.error = error.what();
    if (reply.error.empty()) reply.error = "failed";
  }
  co_await send(shared_from_this(), std::move(reply));
}

Task<void> ConductorConnection::send(Self self, NodeAnswer answer) {
  try {
    co_await self->stream_->send(encode(answer));
  } catch (const StreamError&) {
    self->stream_->close();  // serve() then ends and returns the reason
  }
}

void ConductorConnection::notify(const std::string& notice, const nlohmann::json& details) {
  NodeAnswer answer;
  answer.notice = notice;
  answer.details = details;
  asio::co_spawn(context_, send(shared_from_this(), std::move(answer)), asio::detached);
}

}  // namespace simbench::hardware
