// The inside of a PeerNetwork. Held by it and by every operation that is under way; stop() ends
// those, and from then on the node's clock is not touched.
//
// A stream between hosts carries messages of one tag byte and their content: kPort, two bytes, once
// at the start (where the sender takes datagrams, for who does not know it from the rig file), and
// kMessage, one of the stream channel's.
#ifndef SIMBENCH_HARDWARE_NET_PEER_NETWORK_STATE_H_
#define SIMBENCH_HARDWARE_NET_PEER_NETWORK_STATE_H_

#include <array>
#include <boost/asio/cancellation_signal.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "hardware/net/datagram.h"
#include "hardware/net/kernel_stamps.h"
#include "hardware/net/notice.h"
#include "hardware/net/peer_network.h"
#include "hardware/net/token_bucket.h"

namespace simbench::hardware {

class PeerNetwork::State : public std::enable_shared_from_this<State> {
 public:
  using Self = std::shared_ptr<State>;
  using ConductorHandler = std::function<void(std::unique_ptr<SecureStream>)>;

  State(boost::asio::io_context& context, PeerNetworkSettings settings, NodeClock& clock);

  void start();
  void stop();
  void on_conductor(ConductorHandler handler) { on_conductor_ = std::move(handler); }
  std::uint16_t port() const { return port_; }
  MessageChannel& channel(PeerId peer, Transport transport);
  void clear();
  bool connected(PeerId peer) const;
  const NetworkStatistics& statistics() const { return statistics_; }

  // What the channels do.
  static Task<MessageId> send_by_stream(Self self, PeerId peer, Bytes message);
  MessageId send_datagram(PeerId peer, const Bytes& message);
  static Task<std::optional<ReceivedMessage>> receive(Self self, PeerId peer, Transport transport,
                                                      SteadyTime deadline);
  static Task<std::optional<HostTime>> stream_stamp(Self self, PeerId peer, MessageId id,
                                                    SteadyTime deadline);
  static Task<std::optional<HostTime>> datagram_stamp(Self self, MessageId id, SteadyTime deadline);

 private:
  class Channel;

  // All there is about one other host.
  struct Link {
    Link(State& state, PeerId of);
    Inbox& inbox(Transport transport) {
      return transport == Transport::kStream ? stream_inbox : datagram_inbox;
    }

    PeerId peer;
    std::shared_ptr<SecureStream> stream;  // null while the link is down
    std::uint64_t streams = 0;             // how many there were
    std::optional<DatagramSession> session;
    boost::asio::ip::udp::endpoint datagrams_to;
    // Where its last authentic datagram came from.
    std::optional<boost::asio::ip::udp::endpoint> proven_source;
    Inbox stream_inbox;
    Inbox datagram_inbox;
    Notice connected;
    std::unique_ptr<Channel> stream_channel;
    std::unique_ptr<Channel> datagram_channel;
  };

  // A connection that has not proved the key yet.
  struct Newcomer {
    boost::asio::ip::address from;
    boost::asio::cancellation_signal refuse;
  };
  using Newcomers = std::list<Newcomer>;

  // peer_network.cc
  void bind_sockets();
  Link& link(PeerId peer);
  MonotonicTime deadline_of(SteadyTime deadline) const;
  void deliver(Link& link, Transport transport, Bytes message, MonotonicTime received);

  // peer_streams.cc
  static Task<void> accept_connections(Self self);
  void greet(boost::asio::ip::tcp::socket socket);
  void refuse_one_newcomer();
  void admit(std::unique_ptr<SecureStream> stream);
  static Task<void> keep_connected(Self self, PeerId peer);
  static Task<std::unique_ptr<SecureStream>> connect_to(Self self, PeerId peer);
  static Task<void> serve(Self self, PeerId peer, std::shared_ptr<SecureStream> stream);
  static Task<std::optional<StreamMessage>> next_of(std::shared_ptr<SecureStream> stream);
  void take_over(Link& link, const std::shared_ptr<SecureStream>& stream);
  bool route(Link& link, StreamMessage message);

  // peer_datagrams.cc
  static Task<void> receive_datagrams(Self self);
  bool receive_datagram();
  void judge_datagram(std::span<const std::byte> datagram,
                      const boost::asio::ip::udp::endpoint& from, MonotonicTime received);
  boost::asio::ip::udp::endpoint destination(const Link& link, const SecureStream& stream) const;
  bool take_datagram_stamps();
  void restart_datagram_numbers();

  boost::asio::io_context& context_;
  PeerNetworkSettings settings_;
  NodeClock& clock_;
  ConductorHandler on_conductor_;
  bool stopped_ = false;
  Notice stopping_;
  NetworkStatistics statistics_;
  std::vector<std::unique_ptr<Link>> links_;  // by host; null for this one

  std::uint16_t port_ = 0;
  boost::asio::ip::tcp::acceptor acceptor_;
  Newcomers newcomers_;
  SourceBuckets connections_allowed_;

  boost::asio::ip::udp::socket datagrams_;
  std::array<std::byte, kMaxDatagramBytes + 1> datagram_{};
  SourceBuckets strangers_allowed_;
  bool stamps_ = false;  // the kernel gives them
  MessageId next_datagram_ = 0;
  std::uint32_t next_number_ = 0;  // as the kernel counts
  TransmitLog transmitted_;
  Notice stamped_;
};

}  // namespace simbench::hardware

#endif  // SIMBENCH_HARDWARE_NET_PEER_NETWORK_STATE_H_
