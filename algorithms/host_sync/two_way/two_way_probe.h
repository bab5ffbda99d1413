// The two ends of a two-way exchange: a server for one client, and the client.
//
// See two_way.h for the protocol and TwoWayMessage for the bytes. Used by every algorithm that
// needs to know the master's clock over the network.
//
//   TwoWayClient client(host, master, own_clock, false);
//   if (auto exchange = co_await client.ask(from_ms(100))) estimator.add(*exchange);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_PROBE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_PROBE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "algorithms/ports/host.h"

namespace simbench {

// The message of the two-way protocols as bytes.
//
// 28 bytes, little-endian, the same for request and reply, so that both directions cost the same
// time on the wire:
//
//   offset  size  field
//   0       2     magic 0x5754 ("TW")
//   2       1     version, 1
//   3       1     kind: 1 request, 2 reply
//   4       4     index: the number of the exchange, from 1
//   8       8     arrived: reply: when the request reached the master, its clock, ns; else 0
//   16      4     replied_index: reply: the exchange whose reply left at `replied`; request: the
//                 one whose departure is wanted; 0: none
//   20      8     replied: reply: ns, else 0
//
// A reply that carries its own departure has replied_index == index; it was read before the send
// call. A departure that was measured can only be told with a later reply (interleaved mode, RFC
// 9769): the client asks for that of the last reply it had.
struct TwoWayMessage {
  enum class Kind : std::uint8_t { kRequest = 1, kReply = 2 };
  Kind kind = Kind::kRequest;
  std::uint32_t index = 0;
  HostTime arrived{};
  std::uint32_t replied_index = 0;
  HostTime replied{};
  friend bool operator==(const TwoWayMessage&, const TwoWayMessage&) = default;
};

inline constexpr std::size_t kTwoWayMessageBytes = 28;

Bytes encode(const TwoWayMessage& message);

// Nothing, if the bytes are not what encode() makes of some message with times within +-4e18 ns.
std::optional<TwoWayMessage> decode_two_way_message(const Bytes& bytes);

// When a message left that send(), called at `begin`, has just returned from: by the host's stamp
// if there is one, else now. A stamp from before the call is one of a coarse clock and does not
// count.
Task<SteadyTime> departure_of(Host& host, MessageChannel& channel, MessageId id, SteadyTime begin,
                              std::shared_ptr<const SteeredClock> clock);

// Answers one client.
class TwoWayServer {
 public:
  TwoWayServer(Host& host, PeerId client, std::shared_ptr<SteeredClock> clock, bool is_naive)
      : host_(host), client_(client), clock_(std::move(clock)), is_naive_(is_naive) {}

  // Answers a message if it is a request, and not an old one; else does nothing.
  Task<void> answer(ReceivedMessage received);

 private:
  static constexpr std::size_t kDepartures = 16;
  struct Departure {
    std::uint32_t index = 0;
    HostTime at{};
  };
  Host& host_;
  PeerId client_;
  std::shared_ptr<SteeredClock> clock_;
  bool is_naive_;
  std::uint32_t last_index_ = 0;
  std::deque<Departure> departures_;  // of the last replies
};

// Answers for ever.
Task<void> serve_two_way(Host& host, PeerId client, std::shared_ptr<SteeredClock> clock,
                         bool is_naive);

class TwoWayClient {
 public:
  TwoWayClient(Host& host, PeerId server, std::shared_ptr<SteeredClock> clock, bool is_naive)
      : host_(host), server_(server), clock_(std::move(clock)), is_naive_(is_naive) {}

  // Sends a request and waits for its reply, at most until `timeout`. Returns the exchange that is
  // complete with that, if one is: this one, or (transmit-stamped) the one answered before. Reports
  // it.
  Task<std::optional<TwoWayExchange>> ask(Nanoseconds timeout);
  std::uint32_t asked() const { return index_; }
  std::uint32_t answered() const { return answered_; }

 private:
  struct Open {
    std::uint32_t index = 0;
    TwoWayExchange exchange;
    HostTime t1{};
    HostTime t4{};
  };

  // Takes a reply to the present request in.
  std::optional<TwoWayExchange> complete(const TwoWayMessage& reply, SteadyTime received);
  TwoWayExchange report(Open& open, HostTime replied);

  Host& host_;
  PeerId server_;
  std::shared_ptr<SteeredClock> clock_;
  bool is_naive_;
  std::uint32_t index_ = 0;
  std::uint32_t answered_ = 0;
  Open present_;
  std::optional<Open> last_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_PROBE_H_
