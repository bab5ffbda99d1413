#include "hardware/net/secure_stream.h"

#include <fmt/format.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cerrno>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "hardware/net/connect.h"
#include "hardware/net/kernel_stamps.h"
#include "hardware/net/notice.h"
#include "hardware/net/wire.h"

namespace simbench::hardware {
namespace {

using Kind = StreamError::Kind;
using boost::asio::ip::tcp;

void set_socket_option(int socket, int level, int name, int value) {
  setsockopt(socket, level, name, &value, sizeof value);
}

// A cut link is detected within some 5 s, whether something is being sent or not.
void prepare_socket(int socket) {
  set_socket_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  set_socket_option(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_socket_option(socket, IPPROTO_TCP, TCP_KEEPIDLE, 2);
  set_socket_option(socket, IPPROTO_TCP, TCP_KEEPINTVL, 1);
  set_socket_option(socket, IPPROTO_TCP, TCP_KEEPCNT, 3);
  set_socket_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, 5000);
}

std::string text_of(const std::optional<tcp::endpoint>& remote) {
  if (!remote) return "a peer that has gone";
  return address_text(remote->address().to_string(), remote->port());
}

// Nothing if the peer has gone.
std::optional<tcp::endpoint> remote_of(const tcp::socket& socket) {
  boost::system::error_code gone;
  const tcp::endpoint remote = socket.remote_endpoint(gone);
  return gone ? std::nullopt : std::optional(remote);
}

bool no_data_now(int error) { return error == EAGAIN || error == EWOULDBLOCK; }

constexpr std::string_view kConfirmation = "simbench: key";

std::span<const std::byte> text_bytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

// The inside of a SecureStream: one reader coroutine that shakes hands and then reads one message
// ahead, a queue of messages to send, and notices for waiting coroutines.
//
// The stream and every pending operation hold it, so the stream may be destroyed at any time:
// close() ends the operations, and the last one releases the state.
class SecureStream::State : public std::enable_shared_from_this<State> {
 public:
  using Self = std::shared_ptr<State>;
  enum class Side : std::uint8_t { kConnected, kAccepted };

  State(boost::asio::ip::tcp::socket socket, const SecretKey& key, PeerName me, Side side);

  // Prepares the socket, sends the hello, starts the reader.
  void start();
  // Returns when the other side has proved that it holds the key; throws StreamError.
  static Task<void> shake_hands(Self self, MonotonicTime deadline);

  static Task<MessageId> send(Self self, Bytes message);
  static Task<StreamMessage> receive(Self self, MonotonicTime deadline);
  static Task<std::optional<MonotonicTime>> transmit_stamp(Self self, MessageId id,
                                                           MonotonicTime deadline);
  void close();

  PeerName peer() const { return theirs_.from; }
  const std::string& address() const { return address_; }
  boost::asio::ip::address remote() const {
    return remote_ ? remote_->address() : boost::asio::ip::address();
  }
  const KeyBytes& session_key() const { return session_key_; }

 private:
  struct Outgoing {
    Bytes bytes;
    std::optional<MessageId> id;  // nothing: part of the handshake
  };

  static Task<void> read_all(Self self);
  static Task<bool> read_hello_of_peer(Self self);
  static Task<bool> read_confirmation(Self self);
  static Task<bool> read_message(Self self);
  // Fills `to`; false if the stream has ended.
  static Task<bool> fill(Self self, std::span<std::byte> to);
  bool take_version(std::span<const std::byte, kHelloStartBytes> start);
  void derive_keys();

  MessageId send_now(const Bytes& message);
  void queue(Bytes bytes, std::optional<MessageId> id);
  void flush();
  bool write_front();
  void watch_for_space();
  void watch_for_stamps();
  // False if the kernel has no stamp.
  bool take_stamps();

  // Ends everything; the first reason is kept.
  void fail(StreamError::Kind kind, const std::string& what);
  [[noreturn]] void throw_failure() const;

  boost::asio::ip::tcp::socket socket_;
  std::optional<boost::asio::ip::tcp::endpoint> remote_;
  std::string address_;
  SecretKey key_;
  Side side_;
  Hello mine_;
  Hello theirs_;
  std::array<std::byte, kHelloBytes> my_hello_{};
  std::array<std::byte, kHelloBytes> their_hello_{};
  KeyBytes session_key_{};
  KeyBytes send_key_{};
  KeyBytes receive_key_{};
  bool confirmed_ = false;
  std::optional<StreamError> failure_;

  std::uint64_t sealed_ = 0;  // messages: the next nonce
  std::uint64_t opened_ = 0;
  MonotonicTime last_piece_{};  // stamp of what fill() read last
  std::optional<StreamMessage> ready_;
  Notice changed_;  // confirmed, ready, failed
  Notice taken_;    // ready_ is free again

  std::deque<Outgoing> outbox_;
  std::size_t outbox_bytes_ = 0;
  std::size_t front_written_ = 0;
  bool waiting_for_space_ = false;
  MessageId next_id_ = 0;

  bool stamps_ = false;  // the kernel gives them
  bool watching_for_stamps_ = false;
  std::uint32_t stream_offset_ = 0;  // bytes handed to the kernel, as its stamps count them
  TransmitLog transmitted_;
  Notice stamped_;
};

SecureStream::State::State(tcp::socket socket, const SecretKey& key, PeerName me, Side side)
    : socket_(std::move(socket)),
      remote_(remote_of(socket_)),
      address_(text_of(remote_)),
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
  prepare_socket(socket_.native_handle());
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
  // Messages that arrived before the end are for receive().
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
    // Without the kernel's stamp, the time of the call: not later than the message left.
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
  if (!take_transmit_stamps(socket_.native_handle(), transmitted_)) return false;
  stamped_.notify();
  return true;
}

// A socket that is in error, or has urgent data, ends every wait at once: after a wait without a
// stamp only the next send waits again.
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

Task<void> SecureStream::State::read_all(Self self) {
  bool more = co_await read_hello_of_peer(self);
  if (!more) co_return;
  self->derive_keys();
  self->queue(sealed_frame(self->send_key_, self->sealed_++, text_bytes(kConfirmation)),
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

// Accepts only a box of this one size, so that an unknown peer costs no memory.
Task<bool> SecureStream::State::read_confirmation(Self self) {
  std::array<std::byte, kFrameHeaderBytes + kConfirmation.size() + kSealBytes> frame{};
  const bool filled = co_await fill(self, frame);
  if (!filled) co_return false;
  const std::span<const std::byte> all(frame);
  const auto opened = open_sealed(self->receive_key_, self->opened_++, all.first(kFrameHeaderBytes),
                                  all.subspan(kFrameHeaderBytes));
  if (!opened || !std::ranges::equal(*opened, text_bytes(kConfirmation))) {
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
      // Transmit stamps end the wait as well, and would end the next one at once.
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

namespace {

// Closes a stream whose handshake fails or is cancelled.
template <class State>
class Guard {
 public:
  explicit Guard(std::shared_ptr<State> state) : state_(std::move(state)) {}
  ~Guard() {
    if (state_) state_->close();
  }
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;
  std::shared_ptr<State> release() { return std::move(state_); }

 private:
  std::shared_ptr<State> state_;
};

}  // namespace

SecureStream::SecureStream(std::shared_ptr<State> state) : state_(std::move(state)) {}

SecureStream::~SecureStream() { state_->close(); }

Task<std::unique_ptr<SecureStream>> SecureStream::connect(boost::asio::io_context& context,
                                                          std::string address, std::uint16_t port,
                                                          SecretKey key, PeerName me,
                                                          MonotonicTime deadline) {
  auto socket = co_await connect_socket(context.get_executor(), address, port, deadline);
  auto state = std::make_shared<State>(std::move(socket), key, me, State::Side::kConnected);
  Guard<State> guard(state);
  state->start();
  co_await State::shake_hands(state, deadline);
  co_return std::unique_ptr<SecureStream>(new SecureStream(guard.release()));
}

Task<std::unique_ptr<SecureStream>> SecureStream::accept(boost::asio::ip::tcp::socket socket,
                                                         SecretKey key, PeerName me,
                                                         MonotonicTime deadline) {
  auto state = std::make_shared<State>(std::move(socket), key, me, State::Side::kAccepted);
  Guard<State> guard(state);
  state->start();
  co_await State::shake_hands(state, deadline);
  co_return std::unique_ptr<SecureStream>(new SecureStream(guard.release()));
}

PeerName SecureStream::peer() const { return state_->peer(); }

std::string SecureStream::peer_address() const { return state_->address(); }

boost::asio::ip::address SecureStream::remote() const { return state_->remote(); }

KeyBytes SecureStream::derived_key(std::uint64_t purpose) const {
  std::array<std::byte, sizeof purpose> which{};
  put_number(which, purpose);
  return derive_key(state_->session_key(), "simbench derived key", which);
}

Task<MessageId> SecureStream::send(Bytes message) {
  return State::send(state_, std::move(message));
}

Task<StreamMessage> SecureStream::receive(MonotonicTime deadline) {
  return State::receive(state_, deadline);
}

Task<std::optional<MonotonicTime>> SecureStream::transmit_stamp(MessageId id,
                                                                MonotonicTime deadline) {
  return State::transmit_stamp(state_, id, deadline);
}

void SecureStream::close() { state_->close(); }

}  // namespace simbench::hardware
