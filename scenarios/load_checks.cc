#include "scenarios/load_checks.h"

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/loader.h"

namespace simbench::scenarios {
namespace {

void check_follows(const Scenario& scenario) {
  const std::vector<std::int64_t>& follows = scenario.hosts.follows;
  if (follows.empty()) return;
  const std::string pointer = "/hosts/follows";
  if (follows.size() != static_cast<std::size_t>(scenario.hosts.count)) {
    fail_at(scenario, pointer,
            fmt::format("found {} hosts, allowed none or one for each of the {} hosts",
                        follows.size(), scenario.hosts.count));
  }
  if (follows.front() != 0) {
    fail_at(scenario, pointer + "/0",
            fmt::format("found {}, allowed 0: the master follows no other host", follows.front()));
  }
  for (std::size_t host = 1; host < follows.size(); ++host) {
    auto at = static_cast<std::int64_t>(host);
    for (std::size_t step = 0; at != 0 && step < follows.size(); ++step) {
      at = follows[static_cast<std::size_t>(at)];
    }
    if (at == 0) continue;
    fail_at(scenario, fmt::format("{}/{}", pointer, host),
            fmt::format("found {}: host {} follows a circle of hosts, allowed a chain or a tree "
                        "that ends at the master, 0, as 0, 0, 1, 2",
                        follows[host], host));
  }
}

void refuse_member(const Scenario& scenario, const std::string& pointer, const Traffic& traffic,
                   const std::string& member, const std::string& kinds) {
  fail_at(scenario, pointer + '/' + member,
          fmt::format("found it beside kind \"{}\", allowed for {} only", to_text(traffic.kind),
                      kinds));
}

void check_traffic_members(const Scenario& scenario, const std::string& pointer,
                           const Traffic& traffic) {
  const bool is_tcp = traffic.kind == TrafficKind::kTcp;
  const Traffic usual;
  if (!is_tcp && !traffic.mbit_per_s) {
    fail_at(scenario, pointer + "/mbit_per_s",
            fmt::format("found nothing, \"{}\" needs its mean rate", to_text(traffic.kind)));
  }
  if (is_tcp && traffic.mbit_per_s) {
    refuse_member(scenario, pointer, traffic, "mbit_per_s",
                  "\"paced\" and \"random\" (TCP that its program limits is \"paced\" in bursts)");
  }
  if (is_tcp && traffic.burst_kb != usual.burst_kb) {
    refuse_member(scenario, pointer, traffic, "burst_kb", "\"paced\" and \"random\"");
  }
  if (!is_tcp && traffic.connections != usual.connections) {
    refuse_member(scenario, pointer, traffic, "connections", "\"tcp\"");
  }
  if (!is_tcp && traffic.congestion != usual.congestion) {
    refuse_member(scenario, pointer, traffic, "congestion", "\"tcp\"");
  }
  if (traffic.kind != TrafficKind::kRandom && traffic.tail_exponent != usual.tail_exponent) {
    refuse_member(scenario, pointer, traffic, "tail_exponent", "\"random\"");
  }
}

void check_traffic(const Scenario& scenario) {
  const Network& network = scenario.network;
  for (std::size_t i = 0; i < network.traffic.size(); ++i) {
    const Traffic& traffic = network.traffic[i];
    const std::string pointer = fmt::format("/network/traffic/{}", i);
    if (network.bandwidth_mbit_per_s == 0) {
      fail_at(scenario, pointer,
              "found traffic, allowed where /network/bandwidth_mbit_per_s is above 0 (infinite)");
    }
    if (network.wifi) {
      fail_at(scenario, pointer,
              "found traffic, allowed none beside /network/wifi: the cell has "
              "its own, /network/wifi/busy");
    }
    if (traffic.from == traffic.to) {
      fail_at(scenario, pointer + "/to",
              fmt::format("found {}, which sends it, allowed another host", traffic.to));
    }
    if (traffic.end_s && *traffic.end_s <= traffic.begin_s) {
      fail_at(
          scenario, pointer + "/end_s",
          fmt::format("found {}, allowed more than begin_s, {}", *traffic.end_s, traffic.begin_s));
    }
    check_traffic_members(scenario, pointer, traffic);
  }
}

}  // namespace

void check_load(const Scenario& scenario) {
  check_follows(scenario);
  check_traffic(scenario);
}

}  // namespace simbench::scenarios
