#include "hardware/relay/network_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <string>

#include "laws/generators.h"
#include "scenarios/loader.h"
#include "scenarios/network_laws.h"
#include "scenarios/scenario_json.h"
#include "scenarios/schema_walk.h"

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

namespace {

// The value in words, for "found".
std::string words_of_value(const std::string& pointer, const nlohmann::json& value) {
  if (value.is_array()) {
    return fmt::format("{} {}", value.size(), pointer.substr(pointer.rfind('/') + 1));
  }
  return value.is_number() ? fmt::format("{}", value.get<double>()) : value.dump();
}

}  // namespace

void check_relay_can(const scenarios::Scenario& scenario) {
  scenarios::for_each_value(
      "", scenarios::ordered_schema(), scenario,
      [&scenario](const std::string& pointer, const nlohmann::ordered_json& node,
                  const nlohmann::json& value) {
        if (!node.contains("x-relay") || node["x-relay"] == "any") return;
        const nlohmann::json relay = node["x-relay"];
        if (value == relay.at("only")) return;
        scenarios::fail_at(scenario, pointer,
                           fmt::format("found {}, allowed where a relay imitates the network: {}",
                                       relay.value("found", words_of_value(pointer, value)),
                                       relay.value("allowed", relay.at("only").dump())));
      });
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
