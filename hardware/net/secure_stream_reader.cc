// What a SecureStream reads: the handshake, then messages.
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <cstring>

#include "hardware/net/frame.h"
#include "hardware/net/kernel_stamps.h"
#include "hardware/net/secure_stream_state.h"

namespace simbench::hardware {
namespace {

using Kind = StreamError::Kind;
using boost::asio::ip::tcp;

constexpr std::string_view kConfirmation = "simbench: key";

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

Task<void> SecureStream::State::read_all(Self self) {
  bool more = co_await read_hello_of_peer(self);
  if (!more) co_return;
  self->derive_keys();
  self->queue(sealed_frame(self->send_key_, self->sealed_++, bytes_of(kConfirmation)),
              std::nullopt);
  more = co_await read_confirmation(self);
  while (more) {
    more = co_await read_message(self);
  }
}

Task<bool> SecureStream::State::read_hello_of_peer(Self self) {
  const std::span<std::byte, kHelloBytes> hello(self->their_hello_);
  bool filled = co_await fill(self, hello.first<kHelloStartBytes>());
  if (!filled || !self->take_version(hello.first<kHelloStartBytes>())) co_return false;
  filled = co_await fill(self, hello.subspan<kHelloStartBytes>());
  if (filled) self->theirs_ = read_hello(hello);
  co_return filled;
}

bool SecureStream::State::take_version(std::span<const std::byte, kHelloStartBytes> start) {
  const auto version = hello_version(start);
  if (!version) {
    fail(Kind::kNotUnderstood, "found something that does not speak as a simbench node does");
    return false;
  }
  if (*version != kProtocolVersion) {
    fail(Kind::kWrongVersion,
         fmt::format("found a simbench that speaks protocol {}, this one speaks {}; "
                     "install the same simbench on all hosts",
                     *version, kProtocolVersion));
    return false;
  }
  return true;
}

void SecureStream::State::derive_keys() {
  const bool connected = side_ == Side::kConnected;
  const auto& first = connected ? my_hello_ : their_hello_;
  const auto& second = connected ? their_hello_ : my_hello_;
  std::array<std::byte, 2 * kHelloBytes> transcript{};
  std::copy(first.begin(), first.end(), transcript.begin());
  std::copy(second.begin(), second.end(), transcript.begin() + kHelloBytes);
  session_key_ = derive_key(key_.bytes(), "simbench session", transcript);
  send_key_ = derive_key(session_key_, "stream of the connecting side", {});
  receive_key_ = derive_key(session_key_, "stream of the accepting side", {});
  if (!connected) std::swap(send_key_, receive_key_);
}

// Before this nothing is accepted but a box of this one size, so an unknown peer costs no memory.
Task<bool> SecureStream::State::read_confirmation(Self self) {
  std::array<std::byte, kFrameHeaderBytes + kConfirmation.size() + kSealBytes> frame{};
  const bool filled = co_await fill(self, frame);
  if (!filled) co_return false;
  const std::span<const std::byte> all(frame);
  const auto opened = open_sealed(self->receive_key_, self->opened_++, all.first(kFrameHeaderBytes),
                                  all.subspan(kFrameHeaderBytes));
  if (!opened || !std::ranges::equal(*opened, bytes_of(kConfirmation))) {
    self->fail(Kind::kWrongKey,
               "found another key than this side's; use the same key file on all hosts");
    co_return false;
  }
  self->confirmed_ = true;
  self->changed_.notify();
  co_return true;
}

Task<bool> SecureStream::State::read_message(Self self) {
  FrameHeader header{};
  bool filled = co_await fill(self, header);
  if (!filled) co_return false;
  const auto size = box_bytes(header);
  if (!size) {
    self->fail(Kind::kNotUnderstood,
               fmt::format("found a message of {} sealed bytes, allowed: {} to {}",
                           number_in(header), kSealBytes, kMaxMessageBytes + kSealBytes));
    co_return false;
  }
  Bytes box(*size);
  filled = co_await fill(self, box);
  if (!filled) co_return false;
  const MonotonicTime received = self->last_piece_;
  auto opened = open_sealed(self->receive_key_, self->opened_++, header, box);
  if (!opened) {
    self->fail(Kind::kNotUnderstood, "found a damaged message, or one out of order");
    co_return false;
  }
  self->ready_ = StreamMessage{.bytes = std::move(*opened), .received = received};
  self->changed_.notify();
  while (self->ready_ && !self->failure_) {
    co_await self->taken_.wait(MonotonicTime::max());
  }
  co_return !self->failure_;
}

Task<bool> SecureStream::State::fill(Self self, std::span<std::byte> to) {
  while (!to.empty()) {
    if (self->failure_) co_return false;
    const ReceivedPiece piece = receive_stamped(self->socket_.native_handle(), to, nullptr);
    if (piece.error == EAGAIN || piece.error == EWOULDBLOCK) {
      // The wait ends for transmit stamps as well, and would at once if they stayed.
      self->take_stamps();
      boost::system::error_code closed;
      co_await self->socket_.async_wait(
          tcp::socket::wait_read, boost::asio::redirect_error(boost::asio::use_awaitable, closed));
      if (closed) self->fail(Kind::kUnreachable, "the connection was closed");
      continue;
    }
    if (piece.error != 0 || piece.bytes == 0) {
      self->fail(Kind::kUnreachable,
                 piece.error == 0
                     ? std::string(self->confirmed_ ? "the other side closed the connection"
                                                    : "the other side closed the connection "
                                                      "before it had proved its key")
                     : fmt::format("the connection was lost: {}", std::strerror(piece.error)));
      co_return false;
    }
    self->last_piece_ = piece.received;
    to = to.subspan(piece.bytes);
  }
  co_return true;
}

}  // namespace simbench::hardware
