// Estimators of a remote clock from two-way exchanges. They only compute: values in, values out.
//
// In an exchange, sent and received are readings of the own steady clock, arrived and replied of
// the remote system clock. With remote(s) the remote reading at own steady time s and no negative
// delays
//
//   replied - received <= remote(received) - received     a lower bound of the difference
//   remote(sent) - sent <= arrived - sent                 an upper bound
//
// All of these assume equal minimum delays both ways; a difference A between the directions is in
// every result with A / 2, and no stamp reveals it (docs/reference/host_sync.md section 3).
//
//   TwoWayHull hull({});
//   hull.add(exchange);
//   std::optional<ClockLine> line = hull.line();
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "algorithms/host_sync/clock_steering.h"
#include "laws/lower_hull.h"

namespace simbench {

struct TwoWayExchange {
  SteadyTime sent{};      // t1
  HostTime arrived{};     // t2
  HostTime replied{};     // t3
  SteadyTime received{};  // t4

  // Without the time that the peer took.
  Nanoseconds round_trip() const { return (received - sent) - (replied - arrived); }
};

class TwoWayEstimator {
 public:
  virtual ~TwoWayEstimator() = default;
  // Exchanges come in order. Returns whether the line is a new one.
  virtual bool add(const TwoWayExchange& exchange) = 0;
  // Nothing before there are enough exchanges.
  virtual std::optional<ClockLine> line() = 0;
};

// The two-way convex hull: offset and rate of a remote clock together, from the bounds of a window.
//
// Requests bound the remote clock from above, replies from below. A family of lines fits between
// the lower hull of the upper bounds and the upper hull of the lower bounds; the estimate is the
// mid-line of the widest corridor (largest vertical separation), which for delays with equal
// exponential tails both ways is the maximum-likelihood line. The width of the corridor,
//
//   maximised over the rate b:  min_i (U_i - b s_i) - max_j (L_j - b s_j)
//
// is concave in b and its derivative is the distance of the two touched vertices, so bisection
// finds b.
//
// The rate is held at the last good one (0 at the start) while the kept points span less than
// kFirstSpan (kLaterSpan once a rate was known), too short to estimate a rate. If no line of the
// held rate passes between the hulls (delays that are short against the clocks' drift in that
// span), it moves to the nearest rate that has one. |b| is bounded by max_rate_ppm.
//
// When the hulls cross, no line is possible: the remote clock (or a stamp) has jumped. All but the
// exchange just added is then discarded. A jump of less than half the round trip is not detected;
// it leaves with the window.
//
// Complexity: add() O(1) amortised, line() some tens of vertices times 64 steps of bisection.
// Memory bounded (Envelope). Source: docs/reference/host_sync.md section 1 (MOOS, TICSync: line of
// maximum separation).
class TwoWayHull : public TwoWayEstimator {
 public:
  struct Settings {
    Nanoseconds window = from_ms(60e3);
    double max_rate_ppm = 500;
  };
  static constexpr double kFirstSpanNs = 2e9;
  static constexpr double kLaterSpanNs = 10e9;

  explicit TwoWayHull(Settings settings);

  bool add(const TwoWayExchange& exchange) override;
  std::optional<ClockLine> line() override;
  // How often the hulls have crossed.
  std::uint64_t resets() const { return resets_; }
  // The smallest possible round trip along the line: the vertical width of the corridor.
  std::optional<Nanoseconds> width() const;

 private:
  // Intercepts, at x = 0, of the two lines of one rate that touch the hulls.
  struct Corridor {
    double above_ns = std::numeric_limits<double>::infinity();
    double below_ns = -std::numeric_limits<double>::infinity();
    // Whether no line of this rate passes between the hulls.
    bool is_contradictory() const;
  };

  void add_bounds(const TwoWayExchange& exchange);
  double span_ns() const;
  double choose_rate() const;
  // The rate of the widest corridor.
  double widest_rate() const;
  // The rate nearest to the held one with a line between the hulls, if there is any.
  double nearest_possible_rate() const;
  Corridor corridor(double rate) const;

  Settings settings_;
  Envelope upper_bounds_;
  Envelope negated_lower_bounds_;
  std::optional<SteadyTime> zero_;  // x = 0
  Nanoseconds zero_offset_{0};      // y = 0
  double latest_ns_ = 0;
  double rate_ = 0;
  Corridor corridor_;  // of rate_; too narrow if points in it have left the window
  bool rate_is_known_ = false;
  std::uint64_t resets_ = 0;
};

// A remote clock's reading at one instant of the own steady clock.
struct RemoteReading {
  SteadyTime at{};
  HostTime value{};
};

// The offset of the exchange with the smallest round trip (Cristian 1989; libsoftwaresync,
// SimpleNetworkTimeProtocol.java), at the instant of that exchange. At least one exchange.
RemoteReading best_round_trip(std::span<const TwoWayExchange> exchanges);
// Half the difference of the smallest delays of each direction, whichever exchanges they are from:
// maximum likelihood and minimum variance for exponential delays of equal mean beta, standard
// deviation beta / (sqrt(2) N) (Jeske 2005). `rate_ppb`, the known rate of the remote clock against
// the own steady one, is subtracted first. At least one exchange.
RemoteReading independent_minima(std::span<const TwoWayExchange> exchanges, double rate_ppb);

// Takes the shortest of N exchanges: each round of N gives one offset by one of the two functions
// above, and the rate is the least-squares slope of the offsets in the window (kRoundsKept at
// most). An exchange whose bounds lie more than kJumpNs on the wrong side of the line means that a
// clock has jumped: the estimate starts anew, from that exchange alone. With `early_stop`, a round
// ends with the first exchange whose round trip is below that: on a wired network nearly always the
// first one (docs/reference/host_sync.md section 1). Without `estimate_rate` the line is flat and
// goes through the last offset.
//
// Complexity: O(1) an exchange, O(kRoundsKept) a round.
// Source: docs/reference/host_sync.md sections 1, 3 and 4.
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
