// An authenticated, encrypted stream of messages between two holders of the key, over TCP.
//
// Each side opens with a hello of fixed size: magic, protocol number, its name, 32 fresh random
// bytes. Both sides derive one key for each direction from the shared key and the two hellos, so
// recordings of earlier sessions are never accepted. Every message is then a length and a sealed
// box with a counter as nonce; one that is out of order, damaged, or too long ends the stream. The
// first sealed message of each side confirms that it holds the key.
//
// Contract
//  - One receive and any number of sends may be pending. Sends leave in order; the queue is bounded
//    (kMaxQueuedBytes): a peer that does not read ends the stream.
//  - Stamps: `received` is the monotonic instant at which the kernel had the message's last byte,
//    by the kernel's stamp (SO_TIMESTAMPING), else when it was read. Transmit stamps likewise.
//  - All failures throw StreamError with one line for the user; `kind` is its reason.
//  - One thread.
//
// Source: libsodium's secretstream design notes, RFC 8446 section 7 (derivation from both hellos).
//
//   const auto stream =
//       co_await SecureStream::connect(context, "10.0.0.3", port, key, me, deadline);
//   co_await stream->send(bytes);
//   StreamMessage message = co_await stream->receive(deadline);
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "algorithms/ports/host.h"
#include "hardware/clock/monotonic_time.h"
#include "hardware/net/secret_key.h"

namespace simbench::hardware {

// Changes with every change of what goes over the wire; both sides must have the same.
inline constexpr std::uint16_t kProtocolVersion = 2;

// The name of a side: a host's index in the rig file, or the conductor.
struct PeerName {
  static constexpr std::uint32_t kConductor = 0xffffffff;
  std::uint32_t host = kConductor;
  friend bool operator==(PeerName, PeerName) = default;
};

class StreamError : public std::runtime_error {
 public:
  enum class Kind : std::uint8_t {
    kUnreachable,    // no connection, or it was lost
    kTimeout,        // nothing came by the deadline
    kWrongKey,       // the other side does not hold this key
    kWrongVersion,   // it speaks another protocol
    kNotUnderstood,  // it is no simbench node, or sent what is not allowed
  };
  StreamError(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

struct StreamMessage {
  Bytes bytes;
  MonotonicTime received{};
};

class SecureStream {
 public:
  static constexpr std::size_t kMaxMessageBytes = 4u << 20;
  static constexpr std::size_t kMaxQueuedBytes = 16u << 20;

  // Connects and shakes hands; `me` goes to the other side. Throws StreamError.
  static Task<std::unique_ptr<SecureStream>> connect(boost::asio::io_context& context,
                                                     std::string address, std::uint16_t port,
                                                     SecretKey key, PeerName me,
                                                     MonotonicTime deadline);
  // Shakes hands on a connection that was accepted.
  static Task<std::unique_ptr<SecureStream>> accept(boost::asio::ip::tcp::socket socket,
                                                    SecretKey key, PeerName me,
                                                    MonotonicTime deadline);
  ~SecureStream();
  SecureStream(const SecureStream&) = delete;
  SecureStream& operator=(const SecureStream&) = delete;

  PeerName peer() const;
  std::string peer_address() const;         // "10.0.0.3:47110", for messages
  boost::asio::ip::address remote() const;  // unspecified for a peer that was gone at once
  // A key derived from the handshake, the same on both sides, for the datagrams of this pair
  // (peer_network.h). `purpose` separates uses.
  std::array<unsigned char, SecretKey::kBytes> derived_key(std::uint64_t purpose) const;

  // Returns when the message is queued for the socket.
  Task<MessageId> send(Bytes message);
  // The next message. Throws StreamError(kTimeout) at the deadline; the stream stays usable.
  Task<StreamMessage> receive(MonotonicTime deadline);
  // When message `id` was handed to the network, if the kernel reported it by the deadline.
  Task<std::optional<MonotonicTime>> transmit_stamp(MessageId id, MonotonicTime deadline);
  // Ends it; pending calls throw StreamError(kUnreachable).
  void close();

 private:
  class State;
  explicit SecureStream(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

}  // namespace simbench::hardware
