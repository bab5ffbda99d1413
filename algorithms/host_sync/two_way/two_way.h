// Two-way synchronisation: the slaves ask, the master answers, the shortest delays decide.
//
// A service. Each slave sends requests over datagrams, first `exchanges` of them burst_interval
// apart, then one every `interval` (each interval varied by +-10 %, so that no periodic load can
// stay in step), for ever: before, during and after the capture. An estimator
// (two_way_estimators.h, two_way_estimators.h) turns the exchanges into a line of the master's
// clock over the slave's steady clock, and every steer_interval the slave's system clock is steered
// along it (clock_steering.h).
//
// Where the departure is stamped decides how much of the sender's occupancy is in the path:
//   transmit-stamped  t1 and t3 are when the message left: the host's transmit stamp if it has one,
//                     else the clock right after the send call. t3 follows with a later reply.
//   naive             t1 and t3 are read before the send call, as most code does it.
//
// A lost message costs its exchange; duplicates, late replies and bytes that are no message of ours
// are ignored. A slave reports its outcome when its clock was first steered, or once kPatience
// requests have gone unanswered; it goes on asking.
//
// The names: two_way_min_rtt, two_way_independent_minima, two_way_hull, each also as *_naive where
// registered; libsoftwaresync is naive best-of-300 with early stop and without rate, one round
// every round_pause.
//
// Cost: two messages an exchange. Source: docs/reference/host_sync.md section 1; RFC 9769
// (interleaved mode).
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_H_

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "algorithms/host_sync/clock_steering.h"
#include "algorithms/host_sync/two_way/two_way_estimators.h"
#include "algorithms/host_sync/two_way/two_way_probe.h"
#include "algorithms/parameters.h"
#include "algorithms/ports/host_sync.h"

namespace simbench {

struct TwoWaySettings {
  Nanoseconds service_time = from_ms(60e3);  // before the capture
  bool is_naive = false;
  std::size_t exchanges = 16;  // of the first burst, and of a round where there are rounds
  Nanoseconds burst_interval = from_ms(20);
  Nanoseconds interval = from_ms(250);
  Nanoseconds steer_interval = from_ms(1000);
  // After each new line, for estimators that make one per round; zero: goes on.
  Nanoseconds round_pause{0};
  SteeringSettings steering;
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

// The slave's side of every algorithm that learns the master's clock from two-way exchanges: asks,
// estimates, steers, for ever. See two_way.h.
//
// refine() is where more than the network can be brought in: it is asked for the line to steer by
// each time, given the line that the exchanges say.
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
  // One exchange and what follows from it. Returns how long after it the next one is due.
  Task<Nanoseconds> turn();
  void report_outcome(bool is_steered);

  Host& host_;
  PeerId master_;
  TwoWaySettings settings_;
  std::shared_ptr<SteeredClock> clock_;
  TwoWayClient client_;
  std::unique_ptr<TwoWayEstimator> estimator_;
  SteadyTime steer_at_{};
  bool is_reported_ = false;
};

// The parameters of two_way.h with the hull, as every algorithm on top of it declares them.
std::vector<ParameterSpec> two_way_parameters();
TwoWaySettings two_way_settings(const Parameters& parameters);
TwoWayHull::Settings two_way_hull_settings(const Parameters& parameters);

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_H_
