#include "sim/network/link_latency.h"

#include <algorithm>
#include <cstdlib>

#include "scenarios/network_laws.h"

namespace simbench::sim {
namespace {

constexpr ComponentKey kAsymmetry("network: asymmetry");
constexpr ComponentKey kPortAsymmetry("network: asymmetry of a port");

// What the scenario states of the link; null: nothing.
const scenarios::Link* stated_link(const scenarios::Network& network, PeerId from, PeerId to) {
  if (std::min(from, to) != 0) return nullptr;
  const auto found = std::ranges::find(network.links, static_cast<std::int64_t>(std::max(from, to)),
                                       &scenarios::Link::host);
  return found == network.links.end() ? nullptr : &*found;
}

// A frame of 1500 bytes with its headers, preamble and gap.
constexpr double kForeignFrameBits = 8 * 1538;

int switches_between(const scenarios::Network& network, PeerId from, PeerId to) {
  const std::vector<std::int64_t>& switches = network.switch_of_host;
  return switches.empty() ? 1 : 1 + static_cast<int>(std::abs(switches[from] - switches[to]));
}

// How much longer this direction takes than the other.
double asymmetry_ms(const scenarios::Network& network, const scenarios::Link& link,
                    std::uint64_t run_seed, PeerId from, PeerId to) {
  const PeerId lower = std::min(from, to);
  const PeerId higher = std::max(from, to);
  const auto port_ms = [&](PeerId host) {
    return RandomStream(run_seed, kPortAsymmetry, host).normal(network.port_asymmetry_sigma_ms);
  };
  RandomStream draw(run_seed, kAsymmetry, lower, higher);
  const double of_link_ms = link.asymmetry_ms.value_or(draw.normal(network.asymmetry_sigma_ms));
  const double forward_minus_backward_ms = of_link_ms + port_ms(lower) - port_ms(higher);
  return from < to ? forward_minus_backward_ms : -forward_minus_backward_ms;
}

}  // namespace

LinkLatency::LinkLatency(const scenarios::Network& network, std::uint64_t run_seed, PeerId from,
                         PeerId to, double session_latency_ms)
    : network_(&network),
      law_(scenarios::latency_law(network)),
      bursts_(network.burst, run_seed, kLinkBursts, direction_of(from, to)),
      switches_(switches_between(network, from, to)) {
  if (network.cross_traffic_share > 0) {
    foreign_frame_ms_ = kForeignFrameBits / (network.bandwidth_mbit_per_s * 1e3);
  }
  const scenarios::Link* const stated = stated_link(network, from, to);
  static const scenarios::Link unstated;
  const scenarios::Link& link = stated == nullptr ? unstated : *stated;
  const double asymmetry = asymmetry_ms(network, link, run_seed, from, to) / 2;
  const double stated_ms = link.latency_fixed_ms.value_or(network.latency_fixed_ms);
  law_.exponential_ms = link.latency_exponential_ms.value_or(network.latency_exponential_ms);
  if (law_.table_ms.empty()) law_.fixed_ms = stated_ms;
  law_.fixed_ms += session_latency_ms;
  law_.fixed_ms += asymmetry;
  const double least_ms = law_.table_ms.empty() ? stated_ms : law_.table_ms.least();
  cable_ = from_ms(std::max(0.0, least_ms + asymmetry));
}

Nanoseconds LinkLatency::draw(RandomStream& draw, TrueTime left) {
  double latency_ms = law_.draw_ms(draw);
  latency_ms += draw_residence_ms(draw);
  if (bursts_.active(left)) latency_ms += network_->burst.latency_ms;
  return from_ms(std::max(0.0, latency_ms));
}

double LinkLatency::draw_residence_ms(RandomStream& draw) const {
  double residence_ms = switches_ * network_->switch_residence_ms;
  for (int i = 1; i < switches_; ++i) residence_ms += draw.exponential(law_.exponential_ms);
  if (foreign_frame_ms_ == 0) return residence_ms;
  for (int i = 0; i < switches_; ++i) {
    while (draw.chance(network_->cross_traffic_share)) {
      residence_ms += draw.uniform(0, foreign_frame_ms_);
    }
  }
  return residence_ms;
}

}  // namespace simbench::sim
