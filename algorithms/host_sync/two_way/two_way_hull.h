// The two-way convex hull: offset and rate of a remote clock together, from the
// bounds of a window.
//
// Requests bound the remote clock from above, replies from below. Between the
// lower hull of the upper bounds and the upper hull of the lower bounds fits a
// family of lines; taken is the mid-line of the widest corridor (largest
// vertical separation), which for delays with equal exponential tails both ways
// is the maximum-likelihood line. With w the half width,
//
//   maximise over the rate b:  min_i (U_i - b s_i) - max_j (L_j - b s_j)
//
// is concave in b and its derivative is the distance of the two vertices that
// are touched, so b is found by bisection.
//
// The rate is held at the last good one (0 at the start) while the kept points
// span less than kFirstSpan (kLaterSpan once a rate was known): a short span
// says little about a rate. Where no line of the held rate passes between the
// hulls (delays that are short against what the clocks drift apart in that
// span), it moves to the nearest rate of which one does. |b| is bounded by
// max_rate_ppm.
//
// When the hulls cross, no line is possible: the remote clock (or a stamp) has
// jumped. All but the exchange just added is then forgotten. A jump of less
// than half the round trip is not seen so; it leaves with the window.
//
// Complexity: add() O(1) amortised, line() some tens of vertices times 64 steps
// of bisection. Memory bounded (envelope.h). Source: docs/reference/host_sync.md section 1
// (MOOS, TICSync: line of maximum separation).
#ifndef SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_HULL_H_
#define SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_HULL_H_

#include <cstdint>
#include <limits>
#include <optional>

#include "algorithms/host_sync/two_way/envelope.h"
#include "algorithms/host_sync/two_way/two_way_estimator.h"

namespace simbench {

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
  // Smallest possible round trip along the line: the vertical width of the
  // corridor.
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
  // Of the widest corridor.
  double widest_rate() const;
  // The rate nearest to the held one of which a line passes between the hulls,
  // if there is any.
  double nearest_possible_rate() const;
  Corridor corridor(double rate) const;

  Settings settings_;
  Envelope upper_bounds_;
  Envelope negated_lower_bounds_;
  std::optional<SteadyTime> zero_;  // x = 0
  Nanoseconds zero_offset_{0};      // y = 0
  double latest_ns_ = 0;
  double rate_ = 0;
  // Of rate_. Points that have left the window may still be in it: then it is
  // too narrow.
  Corridor corridor_;
  bool rate_is_known_ = false;
  std::uint64_t resets_ = 0;
};

}  // namespace simbench

#endif  // SIMBENCH_ALGORITHMS_HOST_SYNC_TWO_WAY_TWO_WAY_HULL_H_
