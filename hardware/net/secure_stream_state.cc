#include "hardware/net/secure_stream_state.h"

#include <fmt/format.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <cstring>

#include "hardware/net/frame.h"
#include "hardware/net/kernel_stamps.h"

namespace simbench::hardware {
namespace {

using Kind = StreamError::Kind;
using boost::asio::ip::tcp;

void set_option(int socket, int level, int name, int value) {
  setsockopt(socket, level, name, &value, sizeof value);
}

// A link that is cut is found within some 5 s, whether something is being sent or not.
void prepare(int socket) {
  set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(socket, IPPROTO_TCP, TCP_KEEPIDLE, 2);
  set_option(socket, IPPROTO_TCP, TCP_KEEPINTVL, 1);
  set_option(socket, IPPROTO_TCP, TCP_KEEPCNT, 3);
  set_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, 5000);
}

std::string remote_of(const tcp::socket& socket) {
  boost::system::error_code gone;
  const tcp::endpoint remote = socket.remote_endpoint(gone);
  return gone ? "a peer that has gone" : address_text(remote.address().to_string(), remote.port());
}

bool no_data_now(int error) { return error == EAGAIN || error == EWOULDBLOCK; }

}  // namespace

std::string address_text(const std::string& address, std::uint16_t port) {
  const bool ip6 = address.find(':') != std::string::npos;
  return ip6 ? fmt::format("[{}]:{}", address, port) : fmt::format("{}:{}", address, port);
}

SecureStream::State::State(tcp::socket socket, const SecretKey& key, PeerName me, Side side)
    : socket_(std::move(socket)),
      address_(remote_of(socket_)),
      key_(key),
      side_(side),
      mine_(fresh_hello(me)),
      my_hello_(write_hello(mine_)),
      changed_(socket_.get_executor()),
      taken_(socket_.get_executor()),
      stamped_(socket_.get_executor()) {}

void SecureStream::State::start() {
  boost::system::error_code refused;
  socket_.native_non_blocking(true, refused);
  if (refused) return fail(Kind::kUnreachable, refused.message());
  prepare(socket_.native_handle());
  // Before the first byte, so that offsets in the stream count from here.
  stamps_ = request_kernel_stamps(socket_.native_handle());
  queue(Bytes(my_hello_.begin(), my_hello_.end()), std::nullopt);
  boost::asio::co_spawn(socket_.get_executor(), read_all(shared_from_this()),
                        boost::asio::detached);
}

Task<void> SecureStream::State::shake_hands(Self self, MonotonicTime deadline) {
  while (!self->confirmed_ && !self->failure_) {
    const bool in_time = co_await self->changed_.wait(deadline);
    if (in_time || self->confirmed_) continue;
    self->fail(Kind::kTimeout,
               "connected, but found no answer in time; is a simbench node listening there?");
  }
  // What it sent before it ended, if it did, is for receive().
  if (!self->confirmed_) self->throw_failure();
}

Task<MessageId> SecureStream::State::send(Self self, Bytes message) {
  co_return self->send_now(message);
}

MessageId SecureStream::State::send_now(const Bytes& message) {
  if (failure_) throw_failure();
  if (message.size() > kMaxMessageBytes) {
    throw StreamError(Kind::kNotUnderstood,
                      fmt::format("{}: found a message of {} bytes to send, allowed: at most {}",
                                  address_, message.size(), kMaxMessageBytes));
  }
  if (outbox_bytes_ + message.size() > kMaxQueuedBytes) {
    fail(Kind::kUnreachable,
         fmt::format("does not read what it is sent: {} bytes wait for it", outbox_bytes_));
    throw_failure();
  }
  const MessageId id = next_id_++;
  queue(sealed_frame(send_key_, sealed_++, message), id);
  if (failure_) throw_failure();
  return id;
}

Task<StreamMessage> SecureStream::State::receive(Self self, MonotonicTime deadline) {
  while (!self->ready_) {
    if (self->failure_) self->throw_failure();
    const bool in_time = co_await self->changed_.wait(deadline);
    if (!in_time && !self->ready_ && !self->failure_) {
      throw StreamError(Kind::kTimeout, self->address_ + ": found no message in time");
    }
  }
  StreamMessage message = std::move(*self->ready_);
  self->ready_.reset();
  self->taken_.notify();
  co_return message;
}

Task<std::optional<MonotonicTime>> SecureStream::State::transmit_stamp(Self self, MessageId id,
                                                                       MonotonicTime deadline) {
  for (;;) {
    const TransmitLog::Entry* entry = self->transmitted_.find(id);
    if (entry != nullptr && entry->left) co_return entry->left;
    // Without the kernel's stamp: not later than it left.
    if (entry != nullptr && !self->stamps_) co_return entry->called;
    const bool queued =
        !self->outbox_.empty() && self->outbox_.front().id.value_or(0) <= id && id < self->next_id_;
    if ((entry == nullptr && !queued) || self->failure_) co_return std::nullopt;
    if (self->take_stamps()) continue;
    self->watch_for_stamps();
    const bool in_time = co_await self->stamped_.wait(deadline);
    if (!in_time) co_return std::nullopt;
  }
}

void SecureStream::State::close() { fail(Kind::kUnreachable, "the connection was closed"); }

void SecureStream::State::fail(Kind kind, const std::string& what) {
  if (!failure_) failure_.emplace(kind, fmt::format("{}: {}", address_, what));
  boost::system::error_code ignored;
  socket_.shutdown(tcp::socket::shutdown_both, ignored);
  socket_.close(ignored);
  outbox_.clear();
  outbox_bytes_ = 0;
  changed_.notify();
  taken_.notify();
  stamped_.notify();
}

void SecureStream::State::throw_failure() const { throw StreamError(*failure_); }

void SecureStream::State::queue(Bytes bytes, std::optional<MessageId> id) {
  outbox_bytes_ += bytes.size();
  outbox_.push_back({.bytes = std::move(bytes), .id = id});
  flush();
}

void SecureStream::State::flush() {
  while (!outbox_.empty() && !waiting_for_space_) {
    if (!write_front()) return;
  }
}

// False if nothing more can be written now.
bool SecureStream::State::write_front() {
  const Outgoing& front = outbox_.front();
  const MonotonicTime called = monotonic_now();
  const ssize_t put = ::send(socket_.native_handle(), front.bytes.data() + front_written_,
                             front.bytes.size() - front_written_, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (put < 0 && errno == EINTR) return true;
  if (put < 0 && no_data_now(errno)) {
    watch_for_space();
    return false;
  }
  if (put < 0) {
    fail(Kind::kUnreachable, fmt::format("the connection was lost: {}", std::strerror(errno)));
    return false;
  }
  front_written_ += static_cast<std::size_t>(put);
  stream_offset_ += static_cast<std::uint32_t>(put);
  watch_for_stamps();
  if (front_written_ < front.bytes.size()) return true;
  if (front.id) transmitted_.sent(*front.id, stream_offset_ - 1, called);
  outbox_bytes_ -= front.bytes.size();
  front_written_ = 0;
  outbox_.pop_front();
  stamped_.notify();
  return true;
}

void SecureStream::State::watch_for_space() {
  waiting_for_space_ = true;
  socket_.async_wait(tcp::socket::wait_write,
                     [self = shared_from_this()](const boost::system::error_code& error) {
                       self->waiting_for_space_ = false;
                       if (!error) self->flush();
                     });
}

bool SecureStream::State::take_stamps() {
  bool some = false;
  while (const auto stamp = next_transmit_stamp(socket_.native_handle())) {
    transmitted_.stamped(stamp->number, stamp->at);
    some = true;
  }
  if (some) stamped_.notify();
  return some;
}

// A socket that is in error, or has urgent data, would end every wait at once: after one that
// brought nothing the next send waits again.
void SecureStream::State::watch_for_stamps() {
  if (!stamps_ || watching_for_stamps_ || failure_) return;
  watching_for_stamps_ = true;
  socket_.async_wait(tcp::socket::wait_error,
                     [self = shared_from_this()](const boost::system::error_code& error) {
                       self->watching_for_stamps_ = false;
                       if (error || self->failure_) return;
                       if (self->take_stamps()) self->watch_for_stamps();
                     });
}

}  // namespace simbench::hardware
