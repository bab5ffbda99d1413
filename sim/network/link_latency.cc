#include "sim/network/link_latency.h"

#include <algorithm>

namespace simbench::sim {
namespace {

double asymmetry_ms(double sigma_ms, std::uint64_t run_seed, PeerId from, PeerId to) {
  static constexpr ComponentKey kAsymmetry("network: asymmetry");
  RandomStream draw(run_seed, kAsymmetry, std::min(from, to), std::max(from, to));
  const double forward_minus_backward_ms = draw.normal(sigma_ms);
  return from < to ? forward_minus_backward_ms : -forward_minus_backward_ms;
}

}  // namespace

LinkLatency::LinkLatency(const scenarios::Network& network, std::uint64_t run_seed, PeerId from,
                         PeerId to, double session_latency_ms)
    : network_(&network),
      table_ms_(network.latency_quantiles_ms),
      bursts_(network.burst, run_seed, kLinkBursts, direction_of(from, to)) {
  const bool is_table = !table_ms_.empty();
  const double asymmetry = asymmetry_ms(network.asymmetry_sigma_ms, run_seed, from, to) / 2;
  fixed_ms_ = (is_table ? 0 : network.latency_fixed_ms) + session_latency_ms + asymmetry;
  const double least_ms = is_table ? table_ms_.least() : network.latency_fixed_ms;
  cable_ = from_ms(std::max(0.0, least_ms + asymmetry));
}

Nanoseconds LinkLatency::draw(RandomStream& draw, TrueTime left) {
  double latency_ms =
      table_ms_.empty() ? draw_parametric_ms(draw) : fixed_ms_ + table_ms_.value_at(draw.uniform());
  if (bursts_.active(left)) latency_ms += network_->burst.latency_ms;
  return from_ms(std::max(0.0, latency_ms));
}

double LinkLatency::draw_parametric_ms(RandomStream& draw) const {
  const double latency_ms = fixed_ms_ + draw.exponential(network_->latency_exponential_ms);
  // Both are always drawn, so that later draws stay the same.
  const bool has_spike = draw.chance(network_->spike_probability);
  const double spike_ms = draw.uniform(0, network_->spike_max_ms);
  return has_spike ? latency_ms + spike_ms : latency_ms;
}

}  // namespace simbench::sim
