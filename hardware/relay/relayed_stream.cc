#include "hardware/relay/relayed_stream.h"

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <cerrno>
#include <optional>
#include <utility>

#include "hardware/net/kernel_stamps.h"
#include "hardware/net/notice.h"
#include "hardware/net/wire.h"

namespace simbench::hardware {
namespace {

using boost::asio::ip::tcp;
using Error = boost::system::error_code;

constexpr Nanoseconds kFullQueuePause = std::chrono::milliseconds(1);

void prepare(tcp::socket& socket) {
  Error ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.non_blocking(true, ignored);
  request_receive_stamps(socket.native_handle());
}

// Adds what was read; sets `bad` if it is no SecureStream.
std::optional<Bytes> add(MessageSplitter& splitter, std::span<const std::byte> chunk, bool& bad) {
  try {
    return splitter.take(chunk);
  } catch (const RelayError&) {
    bad = true;
    return std::nullopt;
  }
}

}  // namespace

MessageSplitter::MessageSplitter() : wanted_(kHelloBytes) {}

std::optional<Bytes> MessageSplitter::take(std::span<const std::byte> chunk) {
  buffer_.insert(buffer_.end(), chunk.begin(), chunk.end());
  if (buffer_.size() < wanted_) return std::nullopt;
  if (part_ == Part::kLength) {
    FrameHeader header{};
    std::copy(buffer_.begin(), buffer_.end(), header.begin());
    const std::optional<std::size_t> box = box_bytes(header);
    if (!box) throw RelayError("a stream whose next message has an impossible length");
    part_ = Part::kBox;
    wanted_ += *box;
    return std::nullopt;
  }
  part_ = Part::kLength;
  wanted_ = kFrameHeaderBytes;
  return std::exchange(buffer_, {});
}

RelayedStream::RelayedStream(DelayQueue& queue, NetworkLaw& forward, NetworkLaw& backward,
                             tcp::socket accepted)
    : queue_(queue), near_(std::move(accepted)), far_(tcp::socket(near_.socket.get_executor())) {
  near_.law = &forward;
  far_.law = &backward;
}

void RelayedStream::start(tcp::endpoint to, std::function<void()> on_broken) {
  on_broken_ = std::move(on_broken);
  boost::asio::co_spawn(near_.socket.get_executor(), run(shared_from_this(), std::move(to)),
                        boost::asio::detached);
}

void RelayedStream::close() {
  Error ignored;
  near_.socket.close(ignored);
  far_.socket.close(ignored);
}

Task<void> RelayedStream::run(std::shared_ptr<RelayedStream> self, tcp::endpoint to) {
  Error error;
  co_await self->far_.socket.async_connect(
      to, boost::asio::redirect_error(boost::asio::use_awaitable, error));
  if (error || !self->near_.socket.is_open()) {
    self->close();
    co_return;
  }
  prepare(self->near_.socket);
  prepare(self->far_.socket);
  const auto executor = self->near_.socket.get_executor();
  boost::asio::co_spawn(executor, pump(self, self->far_, self->near_), boost::asio::detached);
  co_await pump(self, self->near_, self->far_);
}

// `from` and `to` are members of `self`.
Task<void> RelayedStream::pump(std::shared_ptr<RelayedStream> self, Side& from, Side& to) {
  MessageSplitter splitter;
  std::array<std::byte, 65536> buffer{};
  while (from.socket.is_open()) {
    const std::size_t size = std::min(buffer.size(), splitter.needed());
    const ReceivedPiece piece =
        receive_stamped(from.socket.native_handle(), std::span(buffer).first(size), nullptr);
    if (piece.error == EAGAIN || piece.error == EWOULDBLOCK) {
      Error error;
      co_await from.socket.async_wait(
          tcp::socket::wait_read, boost::asio::redirect_error(boost::asio::use_awaitable, error));
      if (error) break;
      continue;
    }
    bool bad = false;
    std::optional<Bytes> message;
    const bool ended = piece.bytes == 0;
    if (ended) {
      message = Bytes{};  // the end itself
    } else {
      message = add(splitter, std::span(buffer).first(piece.bytes), bad);
    }
    if (bad) {
      self->on_broken_();
      self->close();
      co_return;
    }
    if (!message) continue;
    const MonotonicTime at = from.law->stream(ended ? monotonic_now() : piece.received);
    while (from.socket.is_open() && !self->send_later(to, at, *message)) {
      co_await pause(from.socket.get_executor(), kFullQueuePause);
    }
    if (ended) co_return;
  }
}

bool RelayedStream::send_later(Side& to, MonotonicTime at, Bytes& message) {
  return queue_.add(at, message, [self = shared_from_this(), &to](Bytes due) {
    if (due.empty()) {
      self->close();
    } else {
      self->write(to, std::move(due));
    }
  });
}

void RelayedStream::write(Side& to, Bytes message) {
  if (!to.socket.is_open()) return;
  if (to.unsent.empty()) {
    Error error;
    const std::size_t sent = to.socket.write_some(boost::asio::buffer(message), error);
    if (error && error != boost::asio::error::would_block) return close();
    if (sent == message.size()) return;
    message.erase(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(sent));
  }
  to.unsent_bytes += message.size();
  if (to.unsent_bytes > kMaxUnsentBytes) return close();
  to.unsent.push_back(std::move(message));
  if (to.unsent.size() == 1) write_front(to);
}

void RelayedStream::write_front(Side& to) {
  boost::asio::async_write(to.socket, boost::asio::buffer(to.unsent.front()),
                           [self = shared_from_this(), &to](const Error& error, std::size_t) {
                             if (error) return self->close();
                             to.unsent_bytes -= to.unsent.front().size();
                             to.unsent.pop_front();
                             if (!to.unsent.empty()) self->write_front(to);
                           });
}

}  // namespace simbench::hardware
