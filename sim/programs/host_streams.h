// TCP on the simulated network, as the programs of one host have it, by IPv4 and IPv6.
//
// All connections between two hosts share the port's stream to that host (algorithms/ports/host.h),
// in segments of at most 1448 bytes (IPv6: 1428) with five bytes of head (IPv6: 25, as its head is
// 20 bytes longer) beside those that the network counts anyway. What is complete, in order and
// delayed there is so here; the segments that acknowledge are not sent, but for credit: a receiver
// holds at most 256 KiB that its program has not read, and says what room there is as the program
// reads.
//
// A connection within the host takes no time. Not modelled: time-outs of connecting and of idle
// connections, urgent data, a state after closing (a closed port is free at once). A listener whose
// queue is full refuses. connect() to no family, which ends a connection on Linux, is refused.
//
// The calls return an errno, or 0. pump(peer) is the receiving half, a coroutine for each peer.
//
// Source: tcp(7), listen(2), accept(2), shutdown(2); RFC 9293.
//
//   HostStreams streams(host, 6);
//   auto stream = streams.open(AF_INET, [] {});
//   const shim::Address server = shim::ipv4_address(0x0A000001, 80);
//   const int error = co_await streams.connect(*stream, server);
//   // EINPROGRESS; ready for writing when it is connected, or has failed with stream->error
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/ports/host.h"
#include "shim/protocol.h"
#include "sim/host/sim_host.h"
#include "sim/programs/routes.h"

namespace simbench::sim {

struct StreamSocket {
  enum class State { kFresh, kListening, kConnecting, kOpen, kClosed };

  State state = State::kFresh;
  int family = AF_INET;
  bool only_ipv6 = false;       // IPV6_V6ONLY
  bool states_host = false;     // the program has bound it to its address
  std::uint32_t interface = 0;  // SO_BINDTODEVICE; 0: any
  shim::Address local{};
  shim::Address peer{};
  int error = 0;                  // SO_ERROR
  bool has_ended = false;         // nothing more is written
  bool peer_ended = false;        // nothing more comes
  std::deque<std::byte> input{};  // arrived, and not read yet
  std::size_t to_credit = 0;      // read, and not told to the peer yet
  std::size_t on_the_way = 0;     // written, and not read by the peer as far as is known
  std::size_t backlog = 0;        // the most that `accepted` holds
  std::deque<std::shared_ptr<StreamSocket>> accepted{};  // connected, and waiting for accept()
  std::function<void()> on_change{};
};

// Ports for the programs that ask for none, each the next free one.
class FreePorts {
 public:
  // 0, or EADDRINUSE if those that are bound have them all.
  template <class Bound>
  int give(shim::Address& local, const Bound& bound) {
    for (int tried = 0; tried <= kLast - kFirst; ++tried) {
      const std::uint16_t port = next_;
      next_ = port == kLast ? kFirst : static_cast<std::uint16_t>(port + 1);
      if (std::ranges::any_of(bound, [port](auto& each) { return each->local.port == port; })) {
        continue;
      }
      local.port = port;
      return 0;
    }
    return EADDRINUSE;
  }

 private:
  static constexpr std::uint16_t kFirst = 32'768;
  static constexpr std::uint16_t kLast = 60'999;

  std::uint16_t next_ = kFirst;
};

class HostStreams {
 public:
  static constexpr std::size_t kMostSegment = 1448;  // IPv6: 20 less
  static constexpr std::size_t kWindow = std::size_t{256} << 10;
  static constexpr std::size_t kMostBacklog = 4096;

  // The host must outlive this.
  HostStreams(SimHost& host, std::size_t hosts)
      : host_(host), hosts_(hosts), routes_(host.id(), hosts) {}

  // Streams are known here until they are closed. `on_change` is called whenever a wait for the
  // stream should look again.
  std::shared_ptr<StreamSocket> open(int family, std::function<void()> on_change);
  int bind(StreamSocket& stream, shim::Address address);
  int listen(StreamSocket& stream, std::size_t backlog);
  // Null if there is none.
  std::shared_ptr<StreamSocket> accept(StreamSocket& listener, std::function<void()> on_change);
  Task<int> connect(StreamSocket& stream, shim::Address peer);
  // Takes from the front of `data` what there is room for: EAGAIN if there is none.
  Task<int> write(StreamSocket& stream, std::span<const std::byte> data, std::size_t& written);
  // At most `most` bytes; none at the end of the stream. EAGAIN if there is nothing yet.
  Task<int> read(StreamSocket& stream, std::size_t most, bool leaves_it, Bytes& data);
  // Ends the direction towards the peer, the other, or both (SHUT_WR, SHUT_RD, SHUT_RDWR).
  Task<int> shut_down(StreamSocket& stream, int how);
  Task<void> close(std::shared_ptr<StreamSocket> stream);

  // As of poll().
  static int readiness(const StreamSocket& stream);

  // Receives from a peer, for ever.
  Task<void> pump(PeerId peer);

 private:
  enum class SegmentKind : std::uint8_t { kOpen, kOpened, kRefused, kData, kEnd, kCredit };
  struct Segment {
    SegmentKind kind{};
    shim::Address from{};
    shim::Address to{};
    Bytes data{};
  };

  static Bytes head_of(const Segment& segment);
  // Nothing for what is no segment.
  std::optional<Segment> segment_of(PeerId from, const Bytes& message) const;
  bool is_taken(const StreamSocket& by, const shim::Address& address) const;
  std::shared_ptr<StreamSocket> listener_for(const shim::Address& to) const;
  std::shared_ptr<StreamSocket> find(const shim::Address& local, const shim::Address& peer) const;
  Task<void> transmit(Segment segment);
  Task<void> transmit(const StreamSocket& stream, SegmentKind kind, Bytes data = {});
  Task<void> take(Segment segment);
  Task<void> take_opening(Segment segment);
  static void begin_anew(StreamSocket& stream);
  // Whether the stream is still connected after it.
  static bool apply(StreamSocket& stream, Segment& segment);
  Task<void> give_credit(StreamSocket& stream, std::size_t at_least);

  SimHost& host_;
  std::size_t hosts_;
  Routes routes_;
  std::vector<std::shared_ptr<StreamSocket>> streams_;
  FreePorts ports_;
};

}  // namespace simbench::sim
