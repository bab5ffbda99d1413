// One connection through the relay: from node i to node j, both ways, message by message.
//
// Each message is forwarded when it arrives by the network's law. The end of either side's stream
// travels like a message and closes both. A direction that is no SecureStream closes both at once.
//
// A MessageSplitter finds the ends of a SecureStream's messages without the key. A direction is a
// hello of fixed size and then messages: a length of four bytes and as many bytes of sealed box
// (hardware/net/wire.h); only the length is read. needed() bytes never reach into the next message.
// An impossible length throws RelayError: the stream is no SecureStream, and ends.
//
//   MessageSplitter splitter;
//   while (read(splitter.needed(), chunk)) {
//     if (auto message = splitter.take(chunk)) forward(*message);
//   }
//
//   auto stream = std::make_shared<RelayedStream>(queue, forward_law, backward_law, std::move(a));
//   stream->start(endpoint_of_node_j, [] { ++broken; });
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "algorithms/ports/host.h"
#include "hardware/relay/delay_queue.h"
#include "hardware/relay/network_law.h"

namespace simbench::hardware {

class RelayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class MessageSplitter {
 public:
  MessageSplitter();

  // Bytes to the end of the part that is being read; never 0.
  std::size_t needed() const { return wanted_ - buffer_.size(); }
  // Takes at most needed() bytes, in order. Returns the message with its length if it is complete.
  std::optional<Bytes> take(std::span<const std::byte> chunk);

 private:
  enum class Part : unsigned char { kHello, kLength, kBox };
  Part part_ = Part::kHello;
  std::size_t wanted_;
  Bytes buffer_;
};

class RelayedStream : public std::enable_shared_from_this<RelayedStream> {
 public:
  // The most that waits for a receiver that does not read.
  static constexpr std::size_t kMaxUnsentBytes = 16u << 20;

  // `queue` and the laws outlive the context's run.
  RelayedStream(DelayQueue& queue, NetworkLaw& forward, NetworkLaw& backward,
                boost::asio::ip::tcp::socket accepted);

  // Connects to the other node and relays. Calls `on_broken` if a side is no SecureStream.
  void start(boost::asio::ip::tcp::endpoint to, std::function<void()> on_broken);
  void close();

 private:
  struct Side {
    explicit Side(boost::asio::ip::tcp::socket its_socket) : socket(std::move(its_socket)) {}
    boost::asio::ip::tcp::socket socket;
    NetworkLaw* law = nullptr;  // of what is read here
    std::deque<Bytes> unsent;
    std::size_t unsent_bytes = 0;
  };

  static Task<void> run(std::shared_ptr<RelayedStream> self, boost::asio::ip::tcp::endpoint to);
  static Task<void> pump(std::shared_ptr<RelayedStream> self, Side& from, Side& to);
  // Takes the message. False: the queue is full, and nothing was taken.
  bool send_later(Side& to, MonotonicTime at, Bytes& message);
  void write(Side& to, Bytes message);
  void write_front(Side& to);

  DelayQueue& queue_;
  Side near_;
  Side far_;
  std::function<void()> on_broken_;
};

}  // namespace simbench::hardware
