#include "evaluation/certificates/contradiction.h"

#include <algorithm>
#include <array>

#include "evaluation/certificates/frontier.h"

namespace simbench::evaluation {
namespace {

// Shortest ways from one point to all others over the points from `first` on.
class Ways {
 public:
  Ways(const FactOrder& order, std::uint32_t first, std::uint32_t without)
      : order_(order),
        first_(first),
        without_(without),
        distance_(order.points().size(), Distances::kFar),
        via_(order.points().size(), kAlongClock),
        from_(order.points().size(), kNone),
        before_(order.points().size(), kNone),
        after_(order.points().size(), kNone) {
    std::vector<std::uint32_t> last(order.clocks(), kNone);
    for (std::uint32_t i = first; i < order.points().size(); ++i) {
      before_[i] = std::exchange(last[order.points()[i].clock], i);
      if (before_[i] != kNone) after_[before_[i]] = i;
    }
  }

  // Until nothing changes: there is no negative cycle without the fact that is left out.
  void search(std::uint32_t start) {
    distance_[start] = 0;
    const auto count = static_cast<std::uint32_t>(order_.points().size());
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      for (std::uint32_t i = first_; i < count; ++i) is_changed |= go_on(i);
      for (std::uint32_t i = count; i-- > first_;) is_changed |= go_on(i);
    }
  }

  std::int64_t distance(std::uint32_t point) const { return distance_[point]; }

  // The facts on the way to `end`, from its start on.
  std::vector<std::uint32_t> facts_to(std::uint32_t end) const {
    std::vector<std::uint32_t> facts;
    for (std::uint32_t at = end; from_[at] != kNone; at = from_[at]) {
      if (via_[at] != kAlongClock) facts.push_back(via_[at]);
    }
    std::ranges::reverse(facts);
    return facts;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::uint32_t kAlongClock = kNone;

  bool offer(std::uint32_t from, std::uint32_t to, Picoseconds most, std::uint32_t via) {
    const std::int64_t there = distance_[from] + most.count();
    if (there >= distance_[to]) return false;
    distance_[to] = there;
    via_[to] = via;
    from_[to] = from;
    return true;
  }

  bool go_on(std::uint32_t point) {
    if (distance_[point] >= Distances::kFar) return false;
    bool is_changed = false;
    const ClockPoint& here = order_.points()[point];
    for (const std::uint32_t next : {before_[point], after_[point]}) {
      if (next == kNone) continue;
      const Nanoseconds step = order_.points()[next].local - here.local;
      is_changed |= offer(point, next, order_.rates()[here.clock].most(step), kAlongClock);
    }
    for (const auto facts : {order_.opened_by(point), order_.closed_by(point)}) {
      for (const std::uint32_t number : facts) {
        const ClockFact& fact = order_.facts()[number];
        if (number == without_ || fact.from != point || fact.earlier() < first_) continue;
        is_changed |= offer(point, fact.to, fact.most, number);
      }
    }
    return is_changed;
  }

  const FactOrder& order_;
  std::uint32_t first_;
  std::uint32_t without_;
  std::vector<std::int64_t> distance_;
  std::vector<std::uint32_t> via_;
  std::vector<std::uint32_t> from_;
  std::vector<std::uint32_t> before_, after_;  // the neighbours on the same clock
};

}  // namespace

Contradiction contradiction_of(const FactOrder& order, std::uint32_t closing) {
  const ClockFact& fact = order.facts()[closing];
  Ways ways(order, fact.earlier(), closing);
  ways.search(fact.to);
  Contradiction found;
  found.facts = ways.facts_to(fact.from);
  found.facts.insert(found.facts.begin(), closing);
  found.before = -Picoseconds(ways.distance(fact.from) + fact.most.count());
  return found;
}

std::optional<double> possible_rate_ppm(const CaptureEvidence& evidence) {
  const Assumptions& assumed = evidence.assumptions();
  for (const double ppm : {100.0, 200.0, 500.0, 1000.0}) {
    if (ppm <= std::max(assumed.host_rate_ppm, assumed.camera_rate_ppm)) continue;
    const FactOrder order(evidence, equal_rates(evidence, ppm, ppm));
    FrontierWalk walk(order, FrontierWalk::kForward);
    bool is_possible = true;
    while (is_possible && walk.next() < order.points().size()) is_possible = !walk.take_next();
    if (is_possible) return ppm;
  }
  return std::nullopt;
}

}  // namespace simbench::evaluation
