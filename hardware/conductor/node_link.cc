#include "hardware/conductor/node_link.h"

#include <fmt/format.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <map>
#include <optional>
#include <utility>

#include "hardware/net/connect.h"
#include "hardware/net/notice.h"
#include "hardware/net/secure_stream.h"

namespace simbench::hardware {
namespace {

namespace asio = boost::asio;

NodeError::Kind node_error_kind(const StreamError& error) {
  switch (error.kind()) {
    case StreamError::Kind::kWrongKey:
    case StreamError::Kind::kWrongVersion:
    case StreamError::Kind::kNotUnderstood:
      return NodeError::Kind::kForeign;
    case StreamError::Kind::kUnreachable:
    case StreamError::Kind::kTimeout:
      break;
  }
  return NodeError::Kind::kLost;
}

// A request whose reply has not come.
struct Pending {
  explicit Pending(asio::io_context& context) : news(context.get_executor()) {}
  Notice news;
  std::optional<NodeAnswer> reply;
  bool broken = false;
};

}  // namespace

class NodeLink::State : public std::enable_shared_from_this<NodeLink::State> {
 public:
  State(asio::io_context& context, const RigHost& host, SecretKey key, NoticeHandler on_notice)
      : context_(context),
        host_(host),
        key_(key),
        on_notice_(std::move(on_notice)),
        opened_(context.get_executor()) {}

  Task<nlohmann::json> ask(std::string verb, nlohmann::json arguments, Nanoseconds limit) {
    const auto self = shared_from_this();
    const MonotonicTime deadline = monotonic_now() + limit;
    const std::shared_ptr<SecureStream> stream = co_await open_stream(deadline);
    const NodeRequest request = {next_id_++, std::move(verb), std::move(arguments)};
    const auto pending = std::make_shared<Pending>(context_);
    pending_[request.id] = pending;
    std::optional<StreamError> failure;
    try {
      co_await stream->send(encode(request));
    } catch (const StreamError& error) {
      failure = error;
    }
    bool in_time = !failure;
    while (in_time && !pending->reply && !pending->broken) {
      in_time = co_await pending->news.wait(deadline);
    }
    pending_.erase(request.id);
    if (failure) throw error(node_error_kind(*failure), failure->what());
    if (pending->broken) throw error(NodeError::Kind::kLost, "the connection was lost");
    if (!pending->reply) {
      throw error(NodeError::Kind::kLost,
                  fmt::format("no answer to '{}' in {:.0f} s", request.verb, to_seconds(limit)));
    }
    if (!pending->reply->error.empty()) {
      throw error(NodeError::Kind::kRefused, pending->reply->error);
    }
    co_return std::move(pending->reply->details);
  }

  void close() {
    closed_ = true;
    if (stream_) stream_->close();
    broken();
  }

 private:
  // Errors of streams already begin with the address.
  NodeError error(NodeError::Kind kind, std::string what) const {
    const std::string address = address_text(host_.address, host_.port);
    if (what.starts_with(address + ": ")) what.erase(0, address.size() + 2);
    return {kind, fmt::format("{} ({}): {}", host_.name, address, what)};
  }

  // The stream; one caller opens it while the others wait.
  Task<std::shared_ptr<SecureStream>> open_stream(MonotonicTime deadline) {
    for (bool in_time = true; opening_ && in_time;) in_time = co_await opened_.wait(deadline);
    if (stream_) co_return stream_;
    if (closed_ || opening_) throw error(NodeError::Kind::kLost, "not connected");
    opening_ = true;
    std::optional<StreamError> failure;
    std::shared_ptr<SecureStream> opened;
    try {
      opened =
          co_await SecureStream::connect(context_, host_.address, host_.port, key_, {}, deadline);
    } catch (const StreamError& error) {
      failure = error;
    }
    opening_ = false;
    opened_.notify();
    if (failure) throw error(node_error_kind(*failure), failure->what());
    stream_ = std::move(opened);
    asio::co_spawn(context_, read(shared_from_this(), stream_), asio::detached);
    co_return stream_;
  }

  static Task<void> read(std::shared_ptr<State> state, std::shared_ptr<SecureStream> stream) {
    constexpr Nanoseconds kLong = std::chrono::hours(1);
    for (bool alive = true; alive;) {
      try {
        const StreamMessage message = co_await stream->receive(monotonic_now() + kLong);
        state->take(parse_answer(message.bytes));
      } catch (const StreamError& error) {
        alive = error.kind() == StreamError::Kind::kTimeout;
      } catch (const ProtocolError&) {
        alive = false;
      }
    }
    stream->close();
    if (state->stream_ == stream) state->broken();
  }

  void take(NodeAnswer answer) {
    if (!answer.notice.empty()) {
      if (!closed_) on_notice_(answer);
      return;
    }
    const auto found = pending_.find(answer.id);
    if (found == pending_.end()) return;  // after its limit
    found->second->reply = std::move(answer);
    found->second->news.notify();
  }

  void broken() {
    stream_.reset();
    for (const auto& [id, pending] : pending_) {
      pending->broken = true;
      pending->news.notify();
    }
  }

  asio::io_context& context_;
  RigHost host_;
  SecretKey key_;
  NoticeHandler on_notice_;
  std::shared_ptr<SecureStream> stream_;
  Notice opened_;
  bool opening_ = false;
  bool closed_ = false;
  std::uint64_t next_id_ = 1;
  std::map<std::uint64_t, std::shared_ptr<Pending>> pending_;
};

NodeLink::NodeLink(asio::io_context& context, const RigHost& host, SecretKey key,
                   NoticeHandler on_notice)
    : state_(std::make_shared<State>(context, host, key, std::move(on_notice))) {}
NodeLink::~NodeLink() {
  if (state_) state_->close();
}
NodeLink::NodeLink(NodeLink&&) noexcept = default;

Task<nlohmann::json> NodeLink::ask(std::string verb, nlohmann::json arguments, Nanoseconds limit) {
  return state_->ask(std::move(verb), std::move(arguments), limit);
}
void NodeLink::close() { state_->close(); }

}  // namespace simbench::hardware
