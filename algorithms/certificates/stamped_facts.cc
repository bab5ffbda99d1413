#include "algorithms/certificates/stamped_facts.h"

namespace simbench {

StampedFacts::StampedFacts(std::size_t hosts, Nanoseconds stamp_error,
                           std::optional<Nanoseconds> estimate_error)
    : readings_(hosts), stamp_error_(stamp_error), estimate_error_(estimate_error) {}

void StampedFacts::add(const ClockAdjustment& adjustment) {
  readings_[adjustment.host].add(adjustment);
}

std::optional<SteadyRange> StampedFacts::when(std::uint32_t host, HostTime stamp,
                                              Nanoseconds error) const {
  return readings_[host].when(stamp - error, stamp + error);
}

ExchangeMessages StampedFacts::messages_of(std::uint32_t host, const Exchange& exchange) const {
  ExchangeMessages found;
  found.is_left_out = exchange.is_estimated && !estimate_error_;
  if (found.is_left_out) return found;
  const Nanoseconds error =
      stamp_error_ + (exchange.is_estimated ? *estimate_error_ : Nanoseconds(0));
  const auto message = [&](std::uint32_t from, const std::optional<HostTime>& sent,
                           std::uint32_t to, const std::optional<HostTime>& received) {
    std::optional<HostMessage> usable;
    if (!sent || !received) return usable;
    const auto left = when(from, *sent, error);
    const auto came = when(to, *received, error);
    if (left && came) {
      usable = HostMessage{from, to, left->first, came->last};
    } else {
      ++found.unusable;
    }
    return usable;
  };
  const std::optional<HostTime>& came = exchange.t2 ? exchange.t2 : exchange.t3;
  const std::optional<HostTime>& left = exchange.t3 ? exchange.t3 : exchange.t2;
  found.usable = {message(host, exchange.t1, exchange.peer, came),
                  message(exchange.peer, left, host, exchange.t4)};
  return found;
}

}  // namespace simbench
