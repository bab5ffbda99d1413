#include "hardware/relay/network_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <string>

#include "laws/generators.h"
#include "scenarios/loader.h"
#include "scenarios/network_laws.h"

namespace simbench::hardware {
namespace {

std::uint64_t key_of(std::uint64_t seed, std::uint64_t what, std::uint64_t index) {
  const std::uint64_t root = SplitMix64::mix(seed + SplitMix64::kIncrement);
  return SplitMix64::mix(SplitMix64::mix(root ^ what) ^ index);
}

// A draw of the link, the same from both ends; forward is from the host of lower number.
double half_asymmetry_ms(double sigma_ms, std::uint64_t seed, PeerId from, PeerId to) {
  if (sigma_ms <= 0) return 0;
  SplitMix64 generator(key_of(seed, direction_of(std::min(from, to), std::max(from, to)), 0));
  const double drawn_ms = boost::random::normal_distribution<double>(0, sigma_ms)(generator);
  return (from < to ? drawn_ms : -drawn_ms) / 2;
}

enum DrawKind : std::uint64_t { kDatagramDraws = 1, kStreamDraws = 2 };

}  // namespace

class NetworkLaw::Draws {
 public:
  Draws(std::uint64_t key, DrawKind kind, std::uint64_t index)
      : generator_(key_of(key, kind, index)) {}

  double uniform() { return unit_share(generator_()); }
  bool chance(double probability) { return uniform() < probability; }
  double exponential(double mean) {
    return mean * boost::random::exponential_distribution<double>(1)(generator_);
  }

 private:
  SplitMix64 generator_;
};

void check_relay_can(const scenarios::Scenario& scenario) {
  const scenarios::Network& network = scenario.network;
  const auto refuse_unless_zero = [&](const std::string& pointer, double value) {
    if (value == 0) return;
    scenarios::fail_at(
        scenario, pointer,
        fmt::format("found {}, allowed where a relay imitates the network: 0", value));
  };
  refuse_unless_zero("/network/burst/rate_hz", network.burst.rate_hz);
  refuse_unless_zero("/network/bandwidth_mbit_per_s", network.bandwidth_mbit_per_s);
  refuse_unless_zero("/network/capture_traffic_share", network.capture_traffic_share);
  refuse_unless_zero("/network/latency_session_exponential_ms",
                     network.latency_session_exponential_ms);
  refuse_unless_zero("/network/port_asymmetry_sigma_ms", network.port_asymmetry_sigma_ms);
  refuse_unless_zero("/network/switch_residence_ms", network.switch_residence_ms);
  refuse_unless_zero("/network/cross_traffic_share", network.cross_traffic_share);
  if (!network.switch_of_host.empty()) {
    scenarios::fail_at(scenario, "/network/switch_of_host",
                       "found switches in a line, allowed where a relay imitates the network: one");
  }
  if (network.wifi) {
    scenarios::fail_at(scenario, "/network/wifi",
                       "found a wireless cell, allowed where a relay imitates the network: none");
  }
  if (scenario.hosts.stack) {
    scenarios::fail_at(scenario, "/hosts/stack",
                       "found a stack, allowed where a relay imitates the network: none; the nodes "
                       "have that of their machine");
  }
  if (!network.links.empty()) {
    scenarios::fail_at(scenario, "/network/links",
                       fmt::format("found {} links, allowed where a relay imitates the network: "
                                   "none",
                                   network.links.size()));
  }
  if (network.nagle) {
    scenarios::fail_at(scenario, "/network/nagle",
                       "found true, allowed where a relay imitates the network: false");
  }
  if (network.switch_clock != scenarios::SwitchClockKind::kNone) {
    scenarios::fail_at(
        scenario, "/network/switch_clock",
        fmt::format(R"(found "{}", allowed where a relay imitates the network: "none")",
                    to_text(network.switch_clock)));
  }
}

NetworkLaw::NetworkLaw(const scenarios::Network& network, std::uint64_t seed, PeerId from,
                       PeerId to)
    : network_(network),
      key_(key_of(seed, direction_of(from, to), 1)),
      half_asymmetry_ms_(half_asymmetry_ms(network.asymmetry_sigma_ms, seed, from, to)) {}

Nanoseconds NetworkLaw::latency(Draws& draws) const {
  LatencyLaw law = scenarios::latency_law(network_);
  law.fixed_ms += half_asymmetry_ms_;
  return from_ms(std::max(0.0, law.draw_ms(draws)));
}

NetworkLaw::Arrivals NetworkLaw::datagram(MonotonicTime received) {
  Draws draws(key_, kDatagramDraws, counts_.datagrams++);
  const MonotonicTime arrival = received + latency(draws);
  const MonotonicTime copy_arrival = received + latency(draws);
  const DatagramFate fate = scenarios::datagram_law(network_).draw(draws);
  if (fate.is_lost) {
    ++counts_.lost;
    return {};
  }
  if (fate.is_reordered) ++counts_.reordered;
  const auto arrives = fate.arrivals(arrival, copy_arrival, last_datagram_);
  Arrivals arrivals = {arrives.first};
  if (fate.is_duplicated) {
    ++counts_.duplicated;
    arrivals.push_back(arrives.copy);
  }
  return arrivals;
}

MonotonicTime NetworkLaw::stream(MonotonicTime received) {
  Draws draws(key_, kStreamDraws, counts_.stream_messages++);
  MonotonicTime arrival = received + latency(draws);
  double timeout_ms = network_.retransmit_timeout_ms;
  for (int i = 0; i < kMaxRetransmissions && draws.chance(network_.loss_probability); ++i) {
    ++counts_.retransmissions;
    arrival += from_ms(timeout_ms);
    timeout_ms *= 2;
  }
  last_stream_ = std::max(last_stream_, arrival);
  return last_stream_;
}

}  // namespace simbench::hardware
