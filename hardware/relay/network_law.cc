#include "hardware/relay/network_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <limits>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "scenarios/scenario_json.h"
#include "scenarios/schema_walk.h"

namespace simbench::hardware {
namespace {

// splitmix64 (Steele, Lea and Flood, OOPSLA 2014).
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}

std::uint64_t key_of(std::uint64_t seed, std::uint64_t what, std::uint64_t index) {
  return mix(mix(mix(seed + 0x9E3779B97F4A7C15) ^ what) ^ index);
}

class Generator {
 public:
  using result_type = std::uint64_t;
  explicit Generator(std::uint64_t state) : state_(state) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() { return mix(state_ += 0x9E3779B97F4A7C15); }

 private:
  std::uint64_t state_;
};

// A draw of the link, the same from both ends; forward is from the host of lower number.
double half_asymmetry_ms(double sigma_ms, std::uint64_t seed, PeerId from, PeerId to) {
  if (sigma_ms <= 0) return 0;
  const std::uint64_t link =
      (static_cast<std::uint64_t>(std::min(from, to)) << 32) | std::max(from, to);
  Generator generator(key_of(seed, link, 0));
  const double drawn_ms = boost::random::normal_distribution<double>(0, sigma_ms)(generator);
  return (from < to ? drawn_ms : -drawn_ms) / 2;
}

// Linear between values at equally spaced probabilities from 0 to 1.
double value_at(const std::vector<double>& quantiles, double probability) {
  const double place = probability * static_cast<double>(quantiles.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), quantiles.size() - 1);
  const std::size_t high = std::min(low + 1, quantiles.size() - 1);
  const double fraction = place - static_cast<double>(low);
  return quantiles[low] + fraction * (quantiles[high] - quantiles[low]);
}

enum DrawKind : std::uint64_t { kDatagramDraws = 1, kStreamDraws = 2 };

}  // namespace

class NetworkLaw::Draws {
 public:
  Draws(std::uint64_t key, DrawKind kind, std::uint64_t index)
      : generator_(key_of(key, kind, index)) {}

  double uniform() { return boost::random::uniform_01<double>()(generator_); }
  bool chance(double probability) { return uniform() < probability; }
  double exponential(double mean) {
    return mean * boost::random::exponential_distribution<double>(1)(generator_);
  }

 private:
  Generator generator_;
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
      key_(key_of(seed, (static_cast<std::uint64_t>(from) << 32) | to, 1)),
      fixed_ms_((network.latency_quantiles_ms.empty() ? network.latency_fixed_ms : 0) +
                half_asymmetry_ms(network.asymmetry_sigma_ms, seed, from, to)) {}

Nanoseconds NetworkLaw::latency(Draws& draws) const {
  if (!network_.latency_quantiles_ms.empty()) {
    const double table_ms = value_at(network_.latency_quantiles_ms, draws.uniform());
    return from_ms(std::max(0.0, fixed_ms_ + table_ms));
  }
  double latency_ms = fixed_ms_ + draws.exponential(network_.latency_exponential_ms);
  // Both are always drawn, so that the draws after them stay the same.
  const bool has_spike = draws.chance(network_.spike_probability);
  const double spike_ms = network_.spike_max_ms * draws.uniform();
  if (has_spike) latency_ms += spike_ms;
  return from_ms(std::max(0.0, latency_ms));
}

NetworkLaw::Arrivals NetworkLaw::datagram(MonotonicTime received) {
  Draws draws(key_, kDatagramDraws, counts_.datagrams++);
  const MonotonicTime arrival = received + latency(draws);
  const MonotonicTime copy_arrival = received + latency(draws);
  const bool is_lost = draws.chance(network_.loss_probability);
  const bool is_duplicated = draws.chance(network_.duplicate_probability);
  const bool is_reordered = draws.chance(network_.reorder_probability);
  const double detour_ms = network_.reorder_max_ms * draws.uniform();
  if (is_lost) {
    ++counts_.lost;
    return {};
  }
  const MonotonicTime in_order = std::max(arrival, last_datagram_);
  if (is_reordered) {
    ++counts_.reordered;
  } else {
    last_datagram_ = in_order;
  }
  Arrivals arrivals = {is_reordered ? in_order + from_ms(detour_ms) : in_order};
  if (is_duplicated) {
    ++counts_.duplicated;
    arrivals.push_back(std::max(copy_arrival, in_order));
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
