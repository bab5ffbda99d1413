// Two-way synchronisation: the slaves send requests, the master replies, and an estimator uses the
// exchanges of the shortest delays.
//
// A service. Each slave sends requests over datagrams, first `exchanges` of them burst_interval
// apart, then one every `interval` (each interval varied by +-10 %, so that no periodic load can
// stay in step), for ever: before, during and after the capture. An estimator
// (two_way_estimators.h) turns the exchanges into a line of the master's clock over the slave's
// steady clock, and every steer_interval the slave's system clock is steered along it
// (clock_steering.h).
//
// Where the departure is stamped decides how much of the sender's occupancy is in the path:
//   transmit-stamped  t1 and t3 are when the message left: the host's transmit stamp if it has one,
//                     else the clock right after the send call. t3 follows with a later reply.
//   naive             t1 and t3 are read before the send call, as most code does it.
//
// A lost message costs its exchange; duplicates, late replies and foreign messages are ignored. A
// slave reports its outcome when its clock is first steered, or after kPatience requests without a
// reply; it goes on in either case.
//
// The names: two_way_min_rtt, two_way_independent_minima, two_way_hull, each also as *_naive where
// registered; libsoftwaresync is naive best-of-300 with early stop and without rate, one round
// every round_pause.
//
// Cost: two messages an exchange. Source: docs/reference/host_sync.md section 1; RFC 9769
// (interleaved mode).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/messages.h"
#include "algorithms/host_sync/outcome.h"
#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "algorithms/parameter_binder.h"
#include "algorithms/ports/host_sync.h"

namespace simbench {

// The master's end of the exchanges with one client.
class TwoWayServer {
 public:
  TwoWayServer(Host& host, PeerId client, std::shared_ptr<SteeredClock> clock, bool is_naive)
      : host_(host), client_(client), clock_(std::move(clock)), is_naive_(is_naive) {}

  // Replies to a message if it is a request and not an old one; else does nothing.
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

class TwoWayClient {
 public:
  TwoWayClient(Host& host, PeerId server, std::shared_ptr<SteeredClock> clock, bool is_naive)
      : host_(host), server_(server), clock_(std::move(clock)), is_naive_(is_naive) {}

  // Sends a request and waits up to `timeout` for its reply. Returns and reports the exchange that
  // this completes, if any: this one, or (transmit-stamped) the one answered before.
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

struct TwoWaySettings {
  Nanoseconds service_time = from_ms(60e3);  // before the capture
  bool is_naive = false;
  std::size_t exchanges = 16;  // of the first burst, and of a round where there are rounds
  Nanoseconds burst_interval = from_ms(20);
  Nanoseconds interval = from_ms(250);
  Nanoseconds steer_interval = from_ms(1000);
  // After each new line, for estimators that make one per round; zero: goes on.
  Nanoseconds round_pause{0};
  SteeringSettings steering{};

  // With those of the hull or the minimum that an algorithm on top of it has.
  void bind(ParameterBinder& parameters, TwoWayHull::Settings& estimator);
};

class TwoWay : public HostSync {
 public:
  static constexpr Nanoseconds kReplyTimeout{500'000'000};
  static constexpr std::uint32_t kPatience = 16;

  using MakeEstimator = std::function<std::unique_ptr<TwoWayEstimator>()>;

  TwoWay(TwoWaySettings settings, MakeEstimator make_estimator)
      : settings_(settings), make_estimator_(std::move(make_estimator)) {}
  std::optional<Nanoseconds> warm_up() const override { return settings_.service_time; }
  Task<void> run_master(Host& host, std::vector<PeerId> slaves) override;
  Task<void> run_slave(Host& host, PeerId master) override;

 private:
  TwoWaySettings settings_;
  MakeEstimator make_estimator_;
};

// The slave's side of every algorithm that estimates the master's clock from two-way exchanges:
// sends requests, estimates, steers, for ever.
//
// refine() is where more than the network can be brought in: it gets the line estimated from the
// exchanges and returns the line to steer by.
class TwoWaySlave {
 public:
  TwoWaySlave(Host& host, PeerId master, TwoWaySettings settings,
              std::unique_ptr<TwoWayEstimator> estimator);
  virtual ~TwoWaySlave() = default;

  // Never ends.
  Task<void> run();

 protected:
  virtual Task<ClockLine> refine(ClockLine line);
  Host& host() { return host_; }
  MessageChannel& channel() { return host_.open_channel(master_, Transport::kDatagram); }

 private:
  // One exchange and the steering due after it. Returns the interval to the next one.
  Task<Nanoseconds> turn();
  Host& host_;
  PeerId master_;
  TwoWaySettings settings_;
  std::shared_ptr<SteeredClock> clock_;
  TwoWayClient client_;
  std::unique_ptr<TwoWayEstimator> estimator_;
  SteadyTime steer_at_{};
  OutcomeReport outcome_;
};

}  // namespace simbench
