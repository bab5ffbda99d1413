// The inside of a SecureStream: one reader coroutine that shakes hands and then reads one message
// ahead, a queue of what waits to be sent, and notices for those who wait.
//
// It is held by the stream and by every operation that is under way, so that the stream may go at
// any time: close() ends them, and the last one lets the state go.
#ifndef SIMBENCH_HARDWARE_NET_SECURE_STREAM_STATE_H_
#define SIMBENCH_HARDWARE_NET_SECURE_STREAM_STATE_H_

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hardware/net/hello.h"
#include "hardware/net/notice.h"
#include "hardware/net/sealing.h"
#include "hardware/net/secure_stream.h"
#include "hardware/net/transmit_log.h"

namespace simbench::hardware {

class SecureStream::State : public std::enable_shared_from_this<State> {
 public:
  using Self = std::shared_ptr<State>;
  enum class Side : std::uint8_t { kConnected, kAccepted };

  State(boost::asio::ip::tcp::socket socket, const SecretKey& key, PeerName me, Side side);

  // Prepares the socket, says hello, starts the reader.
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
  // Those that the kernel has; false if it has none.
  bool take_stamps();

  // The first reason counts. Ends everything.
  void fail(StreamError::Kind kind, const std::string& what);
  [[noreturn]] void throw_failure() const;

  boost::asio::ip::tcp::socket socket_;
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

  std::uint64_t sealed_ = 0;  // messages, so: the next nonce
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

// "10.0.0.3:47110", "[::1]:47110".
std::string address_text(const std::string& address, std::uint16_t port);

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_SECURE_STREAM_STATE_H_
