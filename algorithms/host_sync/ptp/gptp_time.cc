#include "algorithms/host_sync/ptp/gptp_time.h"

#include <algorithm>
#include <cmath>

namespace simbench {
namespace {

constexpr int kScaleBits = 41;

}  // namespace

void LinkDelay::add(const PeerDelayExchange& exchange) {
  exchanges_.push_back(exchange);
  if (exchanges_.size() > most_) exchanges_.pop_front();
}

std::optional<double> LinkDelay::rate_ratio() const {
  if (exchanges_.size() < 2) return std::nullopt;
  const PeerDelayExchange& first = exchanges_.front();
  const PeerDelayExchange& last = exchanges_.back();
  if (last.t4 <= first.t4 || last.t3 <= first.t3) return std::nullopt;
  return static_cast<double>(last.t3 - first.t3) / static_cast<double>(last.t4 - first.t4);
}

std::optional<double> LinkDelay::delay() const {
  if (exchanges_.empty()) return std::nullopt;
  const double rate = rate_ratio().value_or(1);
  double sum = 0;
  for (const PeerDelayExchange& each : exchanges_) {
    const auto there = static_cast<double>(each.t3 - each.t2);
    sum += (rate * static_cast<double>(each.t4 - each.t1) - there) / 2;
  }
  return sum / static_cast<double>(exchanges_.size());
}

std::int32_t scaled_rate_offset(double rate) {
  const double scaled = std::ldexp(rate - 1, kScaleBits);
  return static_cast<std::int32_t>(std::llround(std::clamp(scaled, -2147483647.0, 2147483647.0)));
}

double rate_of_scaled(std::int32_t offset) { return 1 + std::ldexp(offset, -kScaleBits); }

}  // namespace simbench
