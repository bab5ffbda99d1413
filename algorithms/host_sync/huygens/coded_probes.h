// What Huygens makes of the probes between two hosts: which of them are pure, and the line between
// the two clocks that they leave room for. Plain classes and functions; they only compute.
//
// Times are counts of nanoseconds of the hosts' raw clocks, which nobody steers; |time| < 2^61.
// Source: Geng et al., NSDI 2018; docs/reference/host_sync.md section 1 (Huygens).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "algorithms/ports/time.h"
#include "laws/line_fit.h"

namespace simbench {

// A probe's way: when it left, on the sender's raw clock, and when it arrived, on the receiver's.
struct ProbeWay {
  std::int64_t left_ns = 0;
  std::int64_t arrived_ns = 0;
};

// The receiving end of coded probes. Probes come in pairs, and a pair is pure if the two arrived
// as far apart as they had left, to within `purity`: then neither has met a queue or a late stamp
// that the other did not meet. When they left is told by a later pair.
//
// Lost, repeated and reordered probes cost their pair only; pairs far below the newest number mean
// that the sender began anew. Complexity: O(1) a probe.
//
//   CodedProbes probes(from_us(1));
//   probes.arrive(7, 0, t2_ns);
//   probes.arrive(7, 1, t4_ns);
//   std::optional<CodedProbes::Pair> pure = probes.departed(7, {t1_ns, t3_ns});
class CodedProbes {
 public:
  using Pair = std::array<ProbeWay, 2>;
  static constexpr std::size_t kOpenPairs = 16;
  static constexpr std::uint32_t kLatePairs = 64;

  explicit CodedProbes(Nanoseconds purity) : purity_ns_(purity.count()) {}

  // Probe `member` (0 or 1) of a pair; a repeated one does not count.
  void arrive(std::uint32_t pair, std::size_t member, std::int64_t arrived_ns);
  // The pair, if it is complete and pure. Each pair is given once.
  std::optional<Pair> departed(std::uint32_t pair, std::array<std::int64_t, 2> left_ns);

  // Pairs until now of which all four stamps are known, and those of them that were pure.
  struct Count {
    std::size_t complete = 0;
    std::size_t pure = 0;
  };
  Count count() const { return count_; }

 private:
  struct Open {
    std::uint32_t number = 0;
    std::array<std::optional<std::int64_t>, 2> arrived_ns{};
  };

  std::int64_t purity_ns_;
  std::deque<Open> open_;  // in order of number
  Count count_;
};

// The line of one raw clock's lead over another: at x of clock a, clock b reads x + lead_ns(x).
struct PairLine {
  std::int64_t x_ns = 0;
  std::int64_t lead_ns = 0;  // at x_ns
  double rate = 0;           // by which the lead grows

  std::int64_t lead_at(std::int64_t x) const {
    return lead_ns + from_ns(rate * static_cast<double>(x - x_ns)).count();
  }
  friend bool operator==(const PairLine&, const PairLine&) = default;
};

// The line of largest margin between two clouds of points (x, lead): no probe from a to b can be
// below the true line, none from b to a above it. It is the middle of the widest corridor, measured
// along y, which for rates far below 1 is the hard-margin support-vector machine of the paper.
// Where the clouds overlap, it is the line that both violate least.
//
// `above` is the lower hull of the points above, `below_negated` the lower hull of the points below
// with y negated; x increases in both (LowerHull). The rate is limited to +-max_rate. Nothing if
// either is empty. The line is given at `x_ns`.
// Complexity: O(vertices): the margin is concave in the rate, with its corners at the hulls'
// slopes.
//
//   std::optional<PairLine> line = separating_line(above.vertices(), below_negated.vertices(), 0,
//   5e-4);
std::optional<PairLine> separating_line(std::span<const LinePoint> above,
                                        std::span<const LinePoint> below_negated, std::int64_t x_ns,
                                        double max_rate);

}  // namespace simbench
