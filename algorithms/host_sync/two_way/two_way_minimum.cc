#include "algorithms/host_sync/two_way/two_way_minimum.h"

#include <algorithm>
#include <cmath>

#include "algorithms/ports/assert.h"

namespace simbench {
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
  line_->value += Nanoseconds(std::llround(mean_y - rate * mean_x));
}

}  // namespace simbench
