
#include "scenarios/wifi_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/scenarios/support.h"

namespace simbench::scenarios {
namespace {

nlohmann::json as_it_is() { return nlohmann::json::object(); }

// A cell whose access point is host 0; `more` replaces members of it.
nlohmann::json cell(const nlohmann::json& more = as_it_is()) {
  auto wifi = nlohmann::json::parse(R"({
    "access_point_host": 0, "rate_mbit_per_s": 54, "basic_rate_mbit_per_s": 6, "preamble_us": 20,
    "sifs_us": 16, "slot_us": 9, "contention_window_min": 15, "contention_window_max": 1023,
    "retry_limit": 7, "collision_probability": 0.05,
    "busy": {"rate_hz": 0.1, "duration_exponential_ms": 200, "latency_ms": 20},
    "power_save": {"idle_ms": 100, "beacon_interval_ms": 102.4, "dtim_period": 1,
                   "wake_up_ms": 2}})");
  wifi.merge_patch(more);
  return wifi;
}

// A scenario with that cell; `beside` begins after it and has further members of the network.
std::string with_cell(const nlohmann::json& more, const std::string& beside = "") {
  return R"("network": {"wifi": )" + cell(more).dump() + beside + "}";
}

TEST(WifiChecks, ACellIsLoadedAsStated) {
  const Scenario scenario = load_derived(with_cell({{"wired_hosts", {4, 5}}}));
  ASSERT_TRUE(scenario.network.wifi.has_value());
  const Wifi& wifi = *scenario.network.wifi;
  EXPECT_EQ(wifi.access_point_host, 0);
  EXPECT_EQ(wifi.wired_hosts, (std::vector<std::int64_t>{4, 5}));
  EXPECT_EQ(wifi.contention_window_max, 1023);
  EXPECT_EQ(wifi.busy.latency_ms, 20);
  ASSERT_TRUE(wifi.power_save.has_value());
  EXPECT_EQ(wifi.power_save->beacon_interval_ms, 102.4);
}

TEST(WifiChecks, WhatMayBeLeftOut) {
  const Scenario scenario =
      load_derived(with_cell({{"access_point_host", nullptr}, {"power_save", nullptr}}));
  ASSERT_TRUE(scenario.network.wifi.has_value());
  EXPECT_FALSE(scenario.network.wifi->access_point_host.has_value());
  EXPECT_FALSE(scenario.network.wifi->power_save.has_value());
  EXPECT_TRUE(scenario.network.wifi->wired_hosts.empty());
  EXPECT_FALSE(load_scenario("18cam_6host_45fps").network.wifi.has_value());
  const Scenario wired = load_derived(with_cell(as_it_is()), {{"/network/wifi", "null"}});
  EXPECT_FALSE(wired.network.wifi.has_value()) << "null forgets the inherited cell";
  const Scenario awake =
      load_derived(with_cell(as_it_is()), {{"/network/wifi/power_save", "null"}});
  EXPECT_FALSE(awake.network.wifi->power_save.has_value());
}

TEST(WifiChecks, HostsOfTheCell) {
  EXPECT_EQ(error_of(with_cell({{"access_point_host", 6}})),
            "my.json:3: /network/wifi/access_point_host: found 6, allowed 0 to 5 (/hosts/count is "
            "6) or null (a device of its own)");
  EXPECT_EQ(error_of(with_cell({{"wired_hosts", {1, 7}}})),
            "my.json:3: /network/wifi/wired_hosts/1: found 7, allowed 0 to 5 (/hosts/count is 6)");
  EXPECT_EQ(error_of(with_cell({{"wired_hosts", {1, 2, 3, 4, 5}}})),
            "my.json:3: /network/wifi: found a cell without stations, allowed at least one of the "
            "6 hosts that is neither access_point_host nor in wired_hosts");
  EXPECT_EQ(error_of(with_cell({{"wired_hosts", {0, 1, 2, 3, 4}}})), "");
}

TEST(WifiChecks, NumbersOfTheCell) {
  EXPECT_EQ(error_of(with_cell({{"contention_window_min", 63}, {"contention_window_max", 31}})),
            "my.json:3: /network/wifi/contention_window_min: found 63, allowed at most "
            "contention_window_max, 31");
  EXPECT_EQ(error_of(with_cell({{"basic_rate_mbit_per_s", 60}})),
            "my.json:3: /network/wifi/basic_rate_mbit_per_s: found 60, allowed at most "
            "rate_mbit_per_s, 54");
  EXPECT_EQ(error_of(with_cell({{"retry_limit", 0}})),
            "my.json:3: /network/wifi/retry_limit: found 0, allowed a whole number from 1 to 255");
  EXPECT_EQ(error_of(with_cell({{"slot_us", nullptr}})),
            "my.json:3: /network/wifi/slot_us: found nothing, allowed a number from 0 to 1000");
  EXPECT_EQ(error_of(R"("network": {"wifi": true})"),
            "my.json:3: /network/wifi: found true, allowed an object or null");
}

TEST(WifiChecks, RatesAndBeaconsOfACell) {
  EXPECT_EQ(error_of(with_cell({{"uplink_rate_mbit_per_s", 5}})),
            "my.json:3: /network/wifi/uplink_rate_mbit_per_s: found 5, allowed at least "
            "basic_rate_mbit_per_s, 6");
  EXPECT_EQ(error_of(with_cell({{"uplink_rate_mbit_per_s", 6}})), "");
  nlohmann::json tsf = nlohmann::json::parse(R"({
    "resolution_us": 1, "beacon_interval_ms": 100, "beacon_loss_probability": 0,
    "beacon_stamp_sigma_us": 0, "receive_sigma_us": 0, "access_point_skew_sigma_ppm": 0,
    "read_before": {"fixed_us": 1, "exponential_us": 0},
    "read_after": {"fixed_us": 1, "exponential_us": 0}})");
  EXPECT_EQ(error_of(with_cell({{"tsf", tsf}})),
            "my.json:3: /network/wifi/tsf/beacon_interval_ms: found 100, allowed power_save's, "
            "102.4, or nothing");
  EXPECT_EQ(error_of(with_cell({{"tsf", tsf}, {"power_save", nullptr}})), "");
}

TEST(WifiChecks, WhatACellDoesNotHave) {
  EXPECT_EQ(error_of(with_cell(as_it_is(), R"(, "switch_of_host": [0, 0, 0, 1, 1, 1])")),
            "my.json:3: /network/switch_of_host: found switches in a line, allowed none beside "
            "/network/wifi: wired hosts share the access point's switch");
  EXPECT_EQ(error_of(with_cell(as_it_is(), R"(, "switch_clock": "transparent")")),
            "my.json:3: /network/switch_clock: found \"transparent\", allowed \"none\" beside "
            "/network/wifi");
  EXPECT_EQ(error_of(with_cell(as_it_is(), R"(, "nagle": true)")),
            "my.json:3: /network/nagle: found true, allowed false beside /network/wifi");
  EXPECT_EQ(error_of(with_cell(as_it_is(), R"(, "capture_traffic_share": 0.5)")),
            "my.json:3: /network/capture_traffic_share: found 0.5, allowed 0 beside /network/wifi");
  EXPECT_EQ(error_of(with_cell(as_it_is(),
                               R"(, "bandwidth_mbit_per_s": 100, "cross_traffic_share": 0.5)")),
            "my.json:3: /network/cross_traffic_share: found 0.5, allowed 0 beside /network/wifi");
}

TEST(WifiChecks, ACellIsDescribedWithItsSources) {
  const Scenario scenario = load_scenario("18cam_6host_45fps", {{"/network/wifi", cell().dump()}});
  const std::vector<ParameterLine> lines = describe(scenario);
  const auto line = std::ranges::find(lines, std::string("/network/wifi/power_save/idle_ms"),
                                      &ParameterLine::pointer);
  ASSERT_NE(line, lines.end());
  EXPECT_EQ(line->value, "100");
  EXPECT_EQ(line->unit, "ms");
  EXPECT_NE(line->meaning.find("sleeps"), std::string::npos);
}

TEST(WifiWarnings, HardwareStampsDoNotKnowTheAir) {
  const auto warned = [](const char* hardware_stamps) {
    std::vector<std::string> lines = warnings(
        load_derived(with_cell(as_it_is()), {{"/hosts/nic/hardware_stamps", hardware_stamps}}));
    return std::ranges::count_if(lines, [](const std::string& line) {
      return line.find("/network/wifi: ") != std::string::npos;
    });
  };
  EXPECT_EQ(warned("true"), 1);
  EXPECT_EQ(warned("false"), 0);
}

}  // namespace
}  // namespace simbench::scenarios
