// Estimators that take the shortest of N exchanges.
//
// best_round_trip: the offset of the exchange with the smallest round trip (Cristian 1989;
// libsoftwaresync, SimpleNetworkTimeProtocol.java), at the instant of that exchange.
// independent_minima: half the difference of the smallest delays of each direction, whichever
// exchanges they are from: maximum likelihood and minimum variance for exponential delays of equal
// mean beta, standard deviation beta / (sqrt(2) N) (Jeske 2005). The clocks must not drift apart
// meanwhile, so the rate known so far is taken out first.
//
// TwoWayMinimum makes rounds of N exchanges out of a stream: each round gives one offset by one of
// the two, and the rate is the least-squares slope of the offsets in the window (kRoundsKept at
// most). An exchange whose bounds lie more than kJumpNs on the wrong side of the line says that a
// clock has jumped: everything starts afresh, from that exchange alone.
// With `early_stop`, a round ends with the first exchange whose round trip is below that: on a
// wired network nearly always the first one (docs/reference/host_sync.md section 1).
// Without `estimate_rate` the line is flat and goes through the last offset.
//
// Complexity: O(1) an exchange, O(kRoundsKept) a round.
// Source: docs/reference/host_sync.md sections 1, 3 and 4.
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_MINIMUM_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_MINIMUM_H_

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/host_sync/two_way/two_way_estimator.h"

namespace simbench {

// A remote clock's reading at one instant of the own steady clock.
struct RemoteReading {
  SteadyTime at{};
  HostTime value{};
};

// For at least one exchange. `rate_ppb`: of the remote clock against the own steady one.
RemoteReading best_round_trip(std::span<const TwoWayExchange> exchanges);
RemoteReading independent_minima(std::span<const TwoWayExchange> exchanges, double rate_ppb);

class TwoWayMinimum : public TwoWayEstimator {
 public:
  enum class Kind { kRoundTrip, kIndependent };
  struct Settings {
    Kind kind = Kind::kRoundTrip;
    std::size_t exchanges = 16;  // of a round
    std::optional<Nanoseconds> early_stop{};
    bool estimate_rate = true;
    Nanoseconds window = from_ms(60e3);  // of the rate
    double max_rate_ppm = 500;
  };
  static constexpr std::size_t kRoundsKept = 64;
  static constexpr double kJumpNs = 2e6;

  explicit TwoWayMinimum(Settings settings) : settings_(settings) {}

  bool add(const TwoWayExchange& exchange) override;
  std::optional<ClockLine> line() override { return line_; }

 private:
  bool is_jump(const TwoWayExchange& exchange) const;
  void add_round(RemoteReading reading);

  Settings settings_;
  std::vector<TwoWayExchange> round_;
  std::deque<RemoteReading> rounds_;
  std::optional<ClockLine> line_;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_MINIMUM_H_
