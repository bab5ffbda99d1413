// One connection through the relay: from node i to node j, both ways, message by message.
//
// Each message is sent on when the network's law has it arrive; the end of either side's stream
// travels like a message and closes both. A direction that is no SecureStream closes both at once.
//
//   auto stream = std::make_shared<RelayedStream>(queue, forward_law, backward_law, std::move(a));
//   stream->start(endpoint_of_node_j, [] { ++broken; });
#ifndef SIMBENCH_HARDWARE_RELAY_RELAYED_STREAM_H_
#define SIMBENCH_HARDWARE_RELAY_RELAYED_STREAM_H_

#include <boost/asio/ip/tcp.hpp>
#include <deque>
#include <functional>
#include <memory>

#include "algorithms/ports/host.h"
#include "hardware/relay/delay_queue.h"
#include "hardware/relay/network_law.h"

namespace simbench::hardware {

class RelayedStream : public std::enable_shared_from_this<RelayedStream> {
 public:
  // What a receiver that does not read may cost.
  static constexpr std::size_t kMaxUnsentBytes = 16u << 20;

  // `queue` and the laws outlive the context's run.
  RelayedStream(DelayQueue& queue, NetworkLaw& forward, NetworkLaw& backward,
                boost::asio::ip::tcp::socket accepted);

  // Connects to the other node and relays. `on_broken` is called if a side sent what is not
  // allowed.
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
  // False: the queue is full.
  bool send_later(Side& to, MonotonicTime at, Bytes message);
  void write(Side& to, Bytes message);
  void write_front(Side& to);

  DelayQueue& queue_;
  Side near_;
  Side far_;
  std::function<void()> on_broken_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_RELAY_RELAYED_STREAM_H_
