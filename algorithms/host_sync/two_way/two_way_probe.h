// The two ends of a two-way exchange: a server for one client, and the client.
//
// See two_way.h for the protocol and two_way_message.h for the bytes. Used by every algorithm that
// needs to know the master's clock over the network.
//
//   TwoWayClient client(host, master, own_clock, false);
//   if (auto exchange = co_await client.ask()) estimator.add(*exchange);
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_PROBE_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_PROBE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/two_way/two_way_estimator.h"
#include "algorithms/host_sync/two_way/two_way_message.h"
#include "algorithms/ports/host.h"

namespace simbench {

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
