#include "algorithms/host_sync/two_way/two_way_estimators.h"

#include <algorithm>

#include "algorithms/ports/assert.h"

namespace simbench {
namespace {

constexpr int kBisections = 64;
// Stamps are rounded; hulls that cross by no more than this are no contradiction.
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
  const SteadyTime at = *zero_ + from_ns(latest_ns_);
  const Nanoseconds offset = zero_offset_ + from_ns(offset_ns);
  return ClockLine{
      .at = at, .value = HostTime(at.time_since_epoch() + offset), .rate_ppb = rate_ * 1e9};
}

std::optional<Nanoseconds> TwoWayHull::width() const {
  if (upper_bounds_.empty()) return std::nullopt;
  const Corridor widest = corridor(choose_rate());
  return from_ns(widest.above_ns - widest.below_ns);
}

namespace {

// A rate from a shorter span would be worse than none.
constexpr Nanoseconds kFirstSpan(2'000'000'000);

}  // namespace

RemoteReading best_round_trip(std::span<const TwoWayExchange> exchanges) {
  SIMBENCH_ASSERT(!exchanges.empty(), "a minimum needs an exchange");
  const auto best = std::min_element(
      exchanges.begin(), exchanges.end(),
      [](const auto& a, const auto& b) { return a.round_trip() < b.round_trip(); });
  // The middles of the two stays: at the peer and between request and reply.
  return {.at = best->sent + (best->received - best->sent) / 2,
          .value = best->arrived + (best->replied - best->arrived) / 2};
}

RemoteReading independent_minima(std::span<const TwoWayExchange> exchanges, double rate_ppb) {
  SIMBENCH_ASSERT(!exchanges.empty(), "a minimum needs an exchange");
  const SteadyTime at = exchanges.back().received;
  const ClockLine zero{
      .at = at,
      .value = HostTime(at.time_since_epoch() +
                        offset_between(exchanges.front().arrived, exchanges.front().sent)),
      .rate_ppb = rate_ppb};
  Nanoseconds request = Nanoseconds::max();
  Nanoseconds reply = Nanoseconds::max();
  for (const TwoWayExchange& exchange : exchanges) {
    request = std::min(request, exchange.arrived - zero.read(exchange.sent));
    reply = std::min(reply, zero.read(exchange.received) - exchange.replied);
  }
  return {.at = at, .value = zero.value + (request - reply) / 2};
}

bool TwoWayMinimum::add(const TwoWayExchange& exchange) {
  if (exchange.round_trip().count() < 0 || exchange.received < exchange.sent) return false;
  if (line_ && settings_.estimate_rate && is_jump(exchange)) {
    rounds_.clear();
    round_.assign(1, exchange);
    add_round(best_round_trip(round_));
    round_.clear();
    return true;
  }
  round_.push_back(exchange);
  const bool is_short = settings_.early_stop && exchange.round_trip() < *settings_.early_stop;
  if (!is_short && round_.size() < settings_.exchanges) return false;
  const double rate_ppb = line_ ? line_->rate_ppb : 0;
  add_round(settings_.kind == Kind::kRoundTrip ? best_round_trip(round_)
                                               : independent_minima(round_, rate_ppb));
  round_.clear();
  return true;
}

bool TwoWayMinimum::is_jump(const TwoWayExchange& exchange) const {
  const Nanoseconds above = exchange.arrived - line_->read(exchange.sent);
  const Nanoseconds below = exchange.replied - line_->read(exchange.received);
  return to_ns(above) < -kJumpNs || to_ns(below) > kJumpNs;
}

void TwoWayMinimum::add_round(RemoteReading reading) {
  rounds_.push_back(reading);
  while (rounds_.size() > kRoundsKept || reading.at - rounds_.front().at > settings_.window) {
    rounds_.pop_front();
  }
  const double old_rate_ppb = line_ ? line_->rate_ppb : 0;
  line_ = ClockLine{.at = reading.at, .value = reading.value, .rate_ppb = 0};
  if (!settings_.estimate_rate) return;
  if (reading.at - rounds_.front().at < kFirstSpan) {
    line_->rate_ppb = old_rate_ppb;
    return;
  }
  // Least squares, relative to the newest reading.
  double mean_x = 0;
  double mean_y = 0;
  const auto count = static_cast<double>(rounds_.size());
  for (const RemoteReading& round : rounds_) {
    mean_x += to_ns(round.at - reading.at) / count;
    mean_y += to_ns((round.value - reading.value) - (round.at - reading.at)) / count;
  }
  double xx = 0;
  double xy = 0;
  for (const RemoteReading& round : rounds_) {
    const double x = to_ns(round.at - reading.at) - mean_x;
    const double y = to_ns((round.value - reading.value) - (round.at - reading.at)) - mean_y;
    xx += x * x;
    xy += x * y;
  }
  const double limit = settings_.max_rate_ppm * 1e-6;
  const double rate = std::clamp(xy / xx, -limit, limit);
  line_->rate_ppb = rate * 1e9;
  line_->value += from_ns(mean_y - rate * mean_x);
}

}  // namespace simbench
