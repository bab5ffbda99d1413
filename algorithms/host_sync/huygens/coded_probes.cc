#include "algorithms/host_sync/huygens/coded_probes.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace simbench {

void CodedProbes::arrive(std::uint32_t pair, std::size_t member, std::int64_t arrived_ns) {
  const bool is_anew =
      !open_.empty() && pair < open_.back().number && open_.back().number - pair > kLatePairs;
  if (is_anew) open_.clear();
  auto found = std::lower_bound(open_.begin(), open_.end(), pair,
                                [](const Open& open, std::uint32_t n) { return open.number < n; });
  if (found == open_.end() || found->number != pair) {
    found = open_.insert(found, {.number = pair, .arrived_ns = {}});
  }
  if (!found->arrived_ns[member]) found->arrived_ns[member] = arrived_ns;
  if (open_.size() > kOpenPairs) open_.pop_front();
}

std::optional<CodedProbes::Pair> CodedProbes::departed(std::uint32_t pair,
                                                       std::array<std::int64_t, 2> left_ns) {
  const auto found = std::find_if(open_.begin(), open_.end(),
                                  [pair](const Open& open) { return open.number == pair; });
  if (found == open_.end()) return std::nullopt;
  const Open open = *found;
  open_.erase(found);
  if (!open.arrived_ns[0] || !open.arrived_ns[1]) return std::nullopt;
  const std::int64_t spread =
      (*open.arrived_ns[1] - *open.arrived_ns[0]) - (left_ns[1] - left_ns[0]);
  ++count_.complete;
  if (std::abs(spread) > purity_ns_) return std::nullopt;
  ++count_.pure;
  return Pair{ProbeWay{left_ns[0], *open.arrived_ns[0]}, ProbeWay{left_ns[1], *open.arrived_ns[1]}};
}

namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

// The next slope of the hulls on the way of the two touched vertices.
struct Corner {
  double above = kEndless;
  double below = kEndless;
  double rate() const { return std::min(above, below); }
};

Corner next_corner(std::span<const LinePoint> above, std::size_t right,
                   std::span<const LinePoint> below_negated, std::size_t left) {
  Corner corner;
  if (right + 1 < above.size()) corner.above = slope_between(above[right], above[right + 1]);
  if (left > 0) corner.below = -slope_between(below_negated[left - 1], below_negated[left]);
  return corner;
}

// The rate at which the two touched vertices change sides: the widest corridor's.
//
// From the lowest rate on, the touched vertex above moves from left to right, the one below from
// right to left, each at the slopes of its hull.
double widest_rate(std::span<const LinePoint> above, std::span<const LinePoint> below_negated,
                   double max_rate) {
  std::size_t right = 0;
  std::size_t left = below_negated.size() - 1;
  double last = -kEndless;
  while (below_negated[left].x > above[right].x) {
    const Corner corner = next_corner(above, right, below_negated, left);
    last = corner.rate();
    if (last == kEndless) return max_rate;
    if (corner.above <= corner.below) ++right;
    if (corner.below <= corner.above) --left;
  }
  if (last == -kEndless) return below_negated[left].x == above[right].x ? 0 : -max_rate;
  if (below_negated[left].x < above[right].x) return last;
  // They face each other: all rates up to the next corner are as wide.
  const double next = next_corner(above, right, below_negated, left).rate();
  return next == kEndless ? last : (last + next) / 2;
}

// The smallest y above the line of that rate through (x, y): relative to it.
double touched_ns(std::span<const LinePoint> hull, double rate, LinePoint origin) {
  double least = kEndless;
  for (const LinePoint& point : hull) {
    const double y = static_cast<double>(point.y - origin.y);
    least = std::min(least, y - rate * static_cast<double>(point.x - origin.x));
  }
  return least;
}

}  // namespace

std::optional<PairLine> separating_line(std::span<const LinePoint> above,
                                        std::span<const LinePoint> below_negated, std::int64_t x_ns,
                                        double max_rate) {
  if (above.empty() || below_negated.empty()) return std::nullopt;
  const double rate = std::clamp(widest_rate(above, below_negated, max_rate), -max_rate, max_rate);
  const std::int64_t y = above.front().y;
  const double above_ns = touched_ns(above, rate, {.x = x_ns, .y = y});
  const double below_ns = -touched_ns(below_negated, -rate, {.x = x_ns, .y = -y});
  return PairLine{
      .x_ns = x_ns, .lead_ns = y + from_ns((above_ns + below_ns) / 2).count(), .rate = rate};
}

}  // namespace simbench
