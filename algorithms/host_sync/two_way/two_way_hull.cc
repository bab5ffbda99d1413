#include "algorithms/host_sync/two_way/two_way_hull.h"

#include <algorithm>
#include <cmath>

namespace simbench {
namespace {

constexpr int kBisections = 64;
// Stamps are rounded; hulls that cross by no more than this are no
// contradiction.
constexpr double kToleranceNs = 1000;

}  // namespace

TwoWayHull::TwoWayHull(Settings settings)
    : settings_(settings),
      upper_bounds_(to_ns(settings.window)),
      negated_lower_bounds_(to_ns(settings.window)) {}

bool TwoWayHull::add(const TwoWayExchange& exchange) {
  if (exchange.round_trip().count() < 0 || exchange.received < exchange.sent) return false;
  if (!zero_) {
    zero_ = exchange.sent;
    zero_offset_ = offset_between(exchange.arrived, exchange.sent);
  }
  add_bounds(exchange);
  if (!corridor_.is_contradictory()) return true;
  corridor_ = corridor(rate_);
  if (!corridor_.is_contradictory()) return true;
  const double rate = nearest_possible_rate();
  corridor_ = corridor(rate);
  if (!corridor_.is_contradictory()) {
    rate_ = rate;
    return true;
  }
  ++resets_;
  upper_bounds_.clear();
  negated_lower_bounds_.clear();
  corridor_ = {};
  add_bounds(exchange);
  return true;
}

bool TwoWayHull::Corridor::is_contradictory() const { return above_ns < below_ns - kToleranceNs; }

double TwoWayHull::span_ns() const {
  return std::min(upper_bounds_.span(), negated_lower_bounds_.span());
}

void TwoWayHull::add_bounds(const TwoWayExchange& exchange) {
  const Nanoseconds above = offset_between(exchange.arrived, exchange.sent) - zero_offset_;
  const Nanoseconds below = offset_between(exchange.replied, exchange.received) - zero_offset_;
  const double sent_ns = to_ns(exchange.sent - *zero_);
  latest_ns_ = to_ns(exchange.received - *zero_);
  upper_bounds_.add(sent_ns, to_ns(above));
  negated_lower_bounds_.add(latest_ns_, -to_ns(below));
  corridor_.above_ns = std::min(corridor_.above_ns, to_ns(above) - rate_ * sent_ns);
  corridor_.below_ns = std::max(corridor_.below_ns, to_ns(below) - rate_ * latest_ns_);
}

double TwoWayHull::choose_rate() const {
  if (span_ns() < (rate_is_known_ ? kLaterSpanNs : kFirstSpanNs)) return rate_;
  return widest_rate();
}

double TwoWayHull::nearest_possible_rate() const {
  double possible = widest_rate();
  if (corridor(possible).is_contradictory()) return possible;
  double impossible = rate_;
  for (int step = 0; step < kBisections; ++step) {
    const double middle = (possible + impossible) / 2;
    (corridor(middle).is_contradictory() ? impossible : possible) = middle;
  }
  return possible;
}

double TwoWayHull::widest_rate() const {
  double low = -settings_.max_rate_ppm * 1e-6;
  double high = -low;
  for (int step = 0; step < kBisections; ++step) {
    const double middle = (low + high) / 2;
    const double above_x = upper_bounds_.touch(middle).x;
    const double below_x = negated_lower_bounds_.touch(-middle).x;
    (below_x > above_x ? low : high) = middle;
  }
  return (low + high) / 2;
}

TwoWayHull::Corridor TwoWayHull::corridor(double rate) const {
  const Envelope::Point above = upper_bounds_.touch(rate);
  const Envelope::Point below = negated_lower_bounds_.touch(-rate);
  return {.above_ns = above.y - rate * above.x, .below_ns = -below.y - rate * below.x};
}

std::optional<ClockLine> TwoWayHull::line() {
  if (upper_bounds_.empty()) return std::nullopt;
  rate_ = choose_rate();
  if (span_ns() >= kLaterSpanNs) rate_is_known_ = true;
  corridor_ = corridor(rate_);
  const double offset_ns = (corridor_.above_ns + corridor_.below_ns) / 2 + rate_ * latest_ns_;
  const SteadyTime at = *zero_ + Nanoseconds(std::llround(latest_ns_));
  const Nanoseconds offset = zero_offset_ + Nanoseconds(std::llround(offset_ns));
  return ClockLine{
      .at = at, .value = HostTime(at.time_since_epoch() + offset), .rate_ppb = rate_ * 1e9};
}

std::optional<Nanoseconds> TwoWayHull::width() const {
  if (upper_bounds_.empty()) return std::nullopt;
  const Corridor widest = corridor(choose_rate());
  return Nanoseconds(std::llround(widest.above_ns - widest.below_ns));
}

}  // namespace simbench
