#include "scenarios/wifi_checks.h"

#include <fmt/format.h>

#include <set>
#include <string>

#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

void check_cell_hosts(const Scenario& scenario, const Wifi& wifi) {
  const std::int64_t hosts = scenario.hosts.count;
  std::set<std::int64_t> no_stations;
  if (wifi.access_point_host) {
    no_stations.insert(*wifi.access_point_host);
    if (*wifi.access_point_host >= hosts) {
      fail_at(scenario, "/network/wifi/access_point_host",
              fmt::format("found {}, allowed 0 to {} (/hosts/count is {}) or null (a device of its "
                          "own)",
                          *wifi.access_point_host, hosts - 1, hosts));
    }
  }
  no_stations.insert(wifi.wired_hosts.begin(), wifi.wired_hosts.end());
  if (no_stations.size() < static_cast<std::size_t>(hosts)) return;
  fail_at(scenario, "/network/wifi",
          fmt::format("found a cell without stations, allowed at least one of the {} hosts that is "
                      "neither access_point_host nor in wired_hosts",
                      hosts));
}

void check_cell_numbers(const Scenario& scenario, const Wifi& wifi) {
  if (wifi.contention_window_min > wifi.contention_window_max) {
    fail_at(scenario, "/network/wifi/contention_window_min",
            fmt::format("found {}, allowed at most contention_window_max, {}",
                        wifi.contention_window_min, wifi.contention_window_max));
  }
  if (wifi.basic_rate_mbit_per_s > wifi.rate_mbit_per_s) {
    fail_at(scenario, "/network/wifi/basic_rate_mbit_per_s",
            fmt::format("found {}, allowed at most rate_mbit_per_s, {}", wifi.basic_rate_mbit_per_s,
                        wifi.rate_mbit_per_s));
  }
  const double up = wifi.uplink_rate_mbit_per_s.value_or(wifi.rate_mbit_per_s);
  if (wifi.basic_rate_mbit_per_s > up) {
    fail_at(scenario, "/network/wifi/uplink_rate_mbit_per_s",
            fmt::format("found {}, allowed at least basic_rate_mbit_per_s, {}", up,
                        wifi.basic_rate_mbit_per_s));
  }
}

// A cell has one schedule of beacons.
void check_beacons(const Scenario& scenario, const Wifi& wifi) {
  if (!wifi.tsf || !wifi.tsf->beacon_interval_ms || !wifi.power_save) return;
  if (*wifi.tsf->beacon_interval_ms == wifi.power_save->beacon_interval_ms) return;
  fail_at(scenario, "/network/wifi/tsf/beacon_interval_ms",
          fmt::format("found {}, allowed power_save's, {}, or nothing",
                      *wifi.tsf->beacon_interval_ms, wifi.power_save->beacon_interval_ms));
}

// The model of the cell has none of these.
void check_beside_cell(const Scenario& scenario) {
  const Network& network = scenario.network;
  if (!network.switch_of_host.empty()) {
    fail_at(scenario, "/network/switch_of_host",
            "found switches in a line, allowed none beside /network/wifi: wired hosts share the "
            "access point's switch");
  }
  if (network.switch_clock != SwitchClockKind::kNone) {
    fail_at(scenario, "/network/switch_clock",
            fmt::format(R"(found "{}", allowed "none" beside /network/wifi)",
                        to_text(network.switch_clock)));
  }
  if (network.nagle) {
    fail_at(scenario, "/network/nagle", "found true, allowed false beside /network/wifi");
  }
  const auto refuse_unless_zero = [&scenario](const std::string& pointer, double value) {
    if (value == 0) return;
    fail_at(scenario, pointer, fmt::format("found {}, allowed 0 beside /network/wifi", value));
  };
  refuse_unless_zero("/network/cross_traffic_share", network.cross_traffic_share);
  refuse_unless_zero("/network/capture_traffic_share", network.capture_traffic_share);
}

}  // namespace

void check_wifi(const Scenario& scenario) {
  if (!scenario.network.wifi) return;
  check_cell_hosts(scenario, *scenario.network.wifi);
  check_cell_numbers(scenario, *scenario.network.wifi);
  check_beacons(scenario, *scenario.network.wifi);
  check_beside_cell(scenario);
}

}  // namespace simbench::scenarios
