#include "hardware/relay/network_law.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/loader.h"
#include "scenarios/schema.h"

namespace simbench::hardware {
namespace {

using testing::HasSubstr;

constexpr int kMessages = 20'000;

MonotonicTime law_at_ms(double ms) { return MonotonicTime(from_ms(ms)); }

scenarios::Network quiet() {
  scenarios::Network network;
  network.latency_fixed_ms = 2;
  network.retransmit_timeout_ms = 200;
  return network;
}

// Within six standard deviations of a binomial count: a good law fails once in 5e8 tests.
void expect_share(std::uint64_t count, double probability) {
  const double sigma = std::sqrt(kMessages * probability * (1 - probability));
  EXPECT_NEAR(static_cast<double>(count), kMessages * probability, 6 * sigma);
}

TEST(NetworkLaw, AFixedLatencyIsExact) {
  NetworkLaw law(quiet(), 1, 0, 1);
  EXPECT_EQ(law.datagram(law_at_ms(10)), NetworkLaw::Arrivals{law_at_ms(12)});
  EXPECT_EQ(law.stream(law_at_ms(11)), law_at_ms(13));
}

TEST(NetworkLaw, ExponentialLatenciesFollowTheirLaw) {
  scenarios::Network network = quiet();
  network.latency_exponential_ms = 0.5;
  NetworkLaw law(network, 7, 1, 0);
  std::vector<double> extra_ms;
  for (int i = 0; i < kMessages; ++i) {
    const double sent_ms = 1000.0 * i;  // far apart: order does not hold any back
    const NetworkLaw::Arrivals arrivals = law.datagram(law_at_ms(sent_ms));
    ASSERT_EQ(arrivals.size(), 1u);
    extra_ms.push_back(to_ms(arrivals[0] - law_at_ms(sent_ms)) - 2);
  }
  std::sort(extra_ms.begin(), extra_ms.end());
  EXPECT_GE(extra_ms.front(), 0);
  double ks = 0;
  for (int i = 0; i < kMessages; ++i) {
    const double law_value = 1 - std::exp(-extra_ms[i] / 0.5);
    ks = std::max({ks, law_value - i / static_cast<double>(kMessages),
                   (i + 1) / static_cast<double>(kMessages) - law_value});
  }
  // exp(-2 n ks^2) is the probability of more: 1e-12.
  EXPECT_LT(ks, std::sqrt(12 * std::log(10.0) / (2 * kMessages)));
}

TEST(NetworkLaw, ATableReplacesTheFormula) {
  scenarios::Network network = quiet();
  network.latency_quantiles_ms = {1, 1, 4};
  NetworkLaw law(network, 3, 0, 1);
  std::uint64_t at_least = 0;
  for (int i = 0; i < kMessages; ++i) {
    const double latency_ms = to_ms(law.stream(law_at_ms(1000.0 * i)) - law_at_ms(1000.0 * i));
    EXPECT_GE(latency_ms, 1);
    EXPECT_LE(latency_ms, 4);
    if (latency_ms == 1) ++at_least;
  }
  expect_share(at_least, 0.5);
}

TEST(NetworkLaw, LosesDoublesAndReordersItsShares) {
  scenarios::Network network = quiet();
  network.loss_probability = 0.1;
  network.duplicate_probability = 0.05;
  network.reorder_probability = 0.2;
  network.reorder_max_ms = 5;
  NetworkLaw law(network, 11, 2, 0);
  std::uint64_t none = 0;
  for (int i = 0; i < kMessages; ++i) {
    if (law.datagram(law_at_ms(i)).empty()) ++none;
  }
  EXPECT_EQ(law.counts().datagrams, static_cast<std::uint64_t>(kMessages));
  EXPECT_EQ(law.counts().lost, none);
  expect_share(none, 0.1);
  expect_share(law.counts().duplicated, 0.9 * 0.05);
  expect_share(law.counts().reordered, 0.9 * 0.2);
}

TEST(NetworkLaw, ADatagramIsOvertakenOnlyIfItIsReordered) {
  scenarios::Network network = quiet();
  network.latency_exponential_ms = 5;
  NetworkLaw law(network, 5, 0, 1);
  MonotonicTime last = MonotonicTime::min();
  for (int i = 0; i < 1000; ++i) {
    const MonotonicTime arrival = law.datagram(law_at_ms(0.1 * i)).front();
    EXPECT_GE(arrival, last);
    last = arrival;
  }
  network.reorder_probability = 0.5;
  network.reorder_max_ms = 50;
  NetworkLaw reordering(network, 5, 0, 1);
  int overtaken = 0;
  last = MonotonicTime::min();
  for (int i = 0; i < 1000; ++i) {
    const MonotonicTime arrival = reordering.datagram(law_at_ms(0.1 * i)).front();
    if (arrival < last) ++overtaken;
    last = arrival;
  }
  EXPECT_GT(overtaken, 100);
}

TEST(NetworkLaw, AStreamIsInOrderAndALossCostsTheTimeout) {
  scenarios::Network network = quiet();
  network.loss_probability = 0.1;
  NetworkLaw law(network, 1, 0, 1);
  MonotonicTime last = MonotonicTime::min();
  double late = 0;
  for (int i = 0; i < kMessages; ++i) {
    const MonotonicTime sent = law_at_ms(1e5 * i);  // later than any retransmission
    const MonotonicTime arrival = law.stream(sent);
    EXPECT_GT(arrival, last);
    last = arrival;
    const double lost_ms = to_ms(arrival - sent) - 2;
    // 200, 200 + 400, 200 + 400 + 800 ...
    const double doublings = std::log2(lost_ms / 200 + 1);
    EXPECT_NEAR(doublings, std::round(doublings), 1e-9);
    late += std::round(doublings);
  }
  EXPECT_EQ(law.counts().retransmissions, static_cast<std::uint64_t>(late));
  // A geometric count has the mean p / (1 - p), variance p / (1 - p)^2.
  EXPECT_NEAR(late, kMessages * 0.1 / 0.9, 6 * std::sqrt(kMessages * 0.1) / 0.9);
}

TEST(NetworkLaw, ALossHoldsUpWhatFollows) {
  scenarios::Network network = quiet();
  network.loss_probability = 0.5;
  NetworkLaw law(network, 2, 0, 1);
  MonotonicTime last = MonotonicTime::min();
  for (int i = 0; i < 100; ++i) {
    const MonotonicTime arrival = law.stream(law_at_ms(i));
    EXPECT_GE(arrival, last);
    last = arrival;
  }
}

TEST(NetworkLaw, BothDirectionsShareTheAsymmetry) {
  scenarios::Network network = quiet();
  network.asymmetry_sigma_ms = 1;
  const auto latency_ms = [&](PeerId from, PeerId to) {
    return to_ms(NetworkLaw(network, 9, from, to).stream(law_at_ms(0)) - law_at_ms(0));
  };
  EXPECT_NEAR(latency_ms(0, 3) + latency_ms(3, 0), 4, 2e-6);
  EXPECT_NE(latency_ms(0, 3), latency_ms(3, 0));
}

TEST(NetworkLaw, DrawsDependOnSeedDirectionAndIndexAlone) {
  scenarios::Network network = quiet();
  network.latency_exponential_ms = 1;
  const auto second_stream = [&](std::uint64_t seed, PeerId from, PeerId to, int datagrams) {
    NetworkLaw law(network, seed, from, to);
    law.stream(law_at_ms(0));
    for (int i = 0; i < datagrams; ++i) law.datagram(law_at_ms(i));
    return law.stream(law_at_ms(1e6));
  };
  EXPECT_EQ(second_stream(1, 0, 1, 0), second_stream(1, 0, 1, 50));
  EXPECT_NE(second_stream(1, 0, 1, 0), second_stream(2, 0, 1, 0));
  EXPECT_NE(second_stream(1, 0, 1, 0), second_stream(1, 1, 0, 0));
}

std::string law_refusal(const std::string& pointer, const std::string& value) {
  const scenarios::Scenario scenario = scenarios::load_scenario(
      "18cam_6host_45fps", {{"/network/nagle", "false"}, {pointer, value}});
  try {
    check_relay_can(scenario);
  } catch (const scenarios::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NetworkLaw, WhatARelayCannotImitateIsRefused) {
  EXPECT_EQ(law_refusal("/network/loss_probability", "0.5"), "");
  EXPECT_THAT(law_refusal("/network/bandwidth_mbit_per_s", "100"),
              HasSubstr("/network/bandwidth_mbit_per_s=100: found 100, allowed"));
  EXPECT_THAT(law_refusal("/network/burst/rate_hz", "1"), HasSubstr("/network/burst/rate_hz"));
  EXPECT_THAT(law_refusal("/network/nagle", "true"), HasSubstr("/network/nagle=true: found true"));
  EXPECT_THAT(law_refusal("/network/switch_clock", "boundary"), HasSubstr("found \"boundary\""));
  EXPECT_THAT(law_refusal("/network/capture_traffic_share", "1"),
              HasSubstr("capture_traffic_share"));
  EXPECT_THAT(law_refusal("/network/latency_session_exponential_ms", "1"),
              HasSubstr("latency_session_exponential_ms"));
  EXPECT_THAT(law_refusal("/network/port_asymmetry_sigma_ms", "0.1"),
              HasSubstr("port_asymmetry_sigma_ms"));
  EXPECT_THAT(law_refusal("/network/links", R"([{"host": 1}])"), HasSubstr("found 1 links"));
  EXPECT_THAT(law_refusal("/network/switch_residence_ms", "0.002"), HasSubstr("residence"));
  EXPECT_THAT(law_refusal("/network/wifi",
                          R"({"rate_mbit_per_s": 54, "basic_rate_mbit_per_s": 6, "preamble_us": 20,
                              "sifs_us": 16, "slot_us": 9, "contention_window_min": 15,
                              "contention_window_max": 1023, "retry_limit": 7,
                              "collision_probability": 0, "busy": {"rate_hz": 0,
                              "duration_exponential_ms": 0, "latency_ms": 0}})"),
              HasSubstr("found a wireless cell"));
  EXPECT_THAT(law_refusal("/network/switch_of_host", "[0, 0, 0, 1, 1, 1]"),
              HasSubstr("allowed where a relay imitates the network: one"));
}

// Counts the members below that say nothing; what an object says holds for its members.
std::size_t silent_members(const nlohmann::ordered_json& node) {
  if (node.contains("x-relay")) {
    const nlohmann::ordered_json& relay = node["x-relay"];
    EXPECT_TRUE(relay == "any" || relay.contains("only")) << node;
    return 0;
  }
  if (!node.contains("properties")) return 1;
  std::size_t silent = 0;
  for (const auto& [key, child] : node["properties"].items()) silent += silent_members(child);
  return silent;
}

TEST(NetworkLaw, EveryMemberOfTheNetworkSaysWhetherARelayCanCarryIt) {
  const nlohmann::ordered_json& network =
      scenarios::ordered_schema().at("properties").at("network");
  ASSERT_GT(network.at("properties").size(), 20U);
  EXPECT_EQ(silent_members(network), 0U);
}

}  // namespace
}  // namespace simbench::hardware
