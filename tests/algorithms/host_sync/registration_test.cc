#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "algorithms/ports/host_sync.h"
#include "algorithms/registry.h"
#include "tests/algorithms/host_sync/script_host.h"
#include "tests/nonempty.h"

namespace simbench {
namespace {

const HostSyncEntry& entry(const std::string& name) {
  const HostSyncEntry* found = find_algorithm<HostSyncEntry>(name);
  if (found == nullptr) throw std::out_of_range(name);
  return *found;
}

std::unique_ptr<HostSync> make_host_sync(const std::string& name,
                                         const ParameterValues& given = {}) {
  return entry(name).make(check_parameters(entry(name).info.parameters, given));
}

TEST(HostSyncRegistration, EveryEntrySaysWhatItIsAndWhereItsNumbersAreFrom) {
  for (const HostSyncEntry& each : nonempty(algorithms<HostSyncEntry>())) {
    EXPECT_FALSE(each.info.summary.empty()) << each.info.name;
    EXPECT_FALSE(each.info.source.empty()) << each.info.name;
    for (const ParameterSpec& spec : each.info.parameters) {
      EXPECT_FALSE(spec.meaning.empty()) << each.info.name << "/" << spec.name;
      EXPECT_FALSE(spec.source.empty()) << each.info.name << "/" << spec.name;
    }
    EXPECT_NE(each.make(check_parameters(each.info.parameters, {})), nullptr) << each.info.name;
  }
}

TEST(HostSyncRegistration, TheNamesAreTheFixedOnes) {
  std::vector<std::string> names;
  for (const HostSyncEntry& each : algorithms<HostSyncEntry>()) names.push_back(each.info.name);
  EXPECT_THAT(names,
              testing::IsSupersetOf({"yoon2021_network", "yoon2021_time", "yoon2021_both",
                                     "yoon2021_neither", "w32time", "free_running", "ntp_last_set",
                                     "oracle", "ntp", "ntp_broadcast_volley", "ntp_broadcast_fixed",
                                     "w32time_domain", "chrony", "chrony_lan", "chrony_lan_fast"}));
}

TEST(HostSyncRegistration, TheLimitsDifferInTheirClocksAndDoNothing) {
  const std::vector<std::pair<std::string, InitialClocks>> limits = {
      {"free_running", InitialClocks::kUnsynchronised},
      {"ntp_last_set", InitialClocks::kLastSet},
      {"oracle", InitialClocks::kMaster}};
  for (const auto& [name, clocks] : limits) {
    const auto algorithm = make_host_sync(name);
    EXPECT_EQ(algorithm->initial_clocks(), clocks) << name;
    EXPECT_FALSE(algorithm->warm_up()) << name;
    ScriptWorld world(3);  // no link: a message would throw
    world.run(*algorithm);
    EXPECT_EQ(world.unfinished(), 0U) << name;
    EXPECT_EQ(world.now(), Nanoseconds{0}) << name;
  }
}

// Error of the slave for 1 ms latency, 4 ms set calls that count half-way, and free sends.
Nanoseconds lead_with(const std::string& name, const ParameterValues& given = {}) {
  ScriptWorld world(2);
  world.set_latency(0, 1, from_ms(1));
  world.set_latency(1, 0, from_ms(1));
  world.host(1).costs.set = from_ms(4);
  world.run(*make_host_sync(name, given));
  return world.host(1).lead_over(world.host(0));
}

TEST(HostSyncRegistration, TheFourAlgorithmsAddWhatTheirNamesSay) {
  const ParameterValues intended = {{"latency_estimate", std::string("intended")}};
  EXPECT_EQ(lead_with("yoon2021_neither", intended), from_ms(-3));
  EXPECT_EQ(lead_with("yoon2021_network", intended), from_ms(-2));
  EXPECT_EQ(lead_with("yoon2021_time", intended), from_ms(-1));
  EXPECT_EQ(lead_with("yoon2021_both", intended), from_ms(0));
  EXPECT_EQ(lead_with("yoon2021_both"), from_ms(-1));  // literal: t_l is 0, as sends are free
}

TEST(HostSyncRegistration, ParametersReachTheAlgorithm) {
  const ParameterValues paced = {{"stamps", 4.0},
                                 {"send_interval_ms", 7.0},
                                 {"clock_calls", 1.0},
                                 {"transport", std::string("datagram")}};
  EXPECT_EQ(lead_with("yoon2021_network", paced), from_ms(7 - 3));
  ScriptWorld world(2);
  world.set_latency(0, 1, from_ms(1));
  world.set_latency(1, 0, from_ms(1));
  world.run(*make_host_sync("yoon2021_both", {{"threshold_ms", 1.5}, {"pass_limit", 7.0}}));
  EXPECT_FALSE(world.host(0).outcomes.at(0).synchronised);
  EXPECT_EQ(world.host(0).outcomes.at(0).passes, 7U);
  EXPECT_EQ(make_host_sync("w32time", {{"service_hours", 2.0}})->warm_up(), from_ms(7200e3));
}

TEST(HostSyncRegistration, ValuesOutOfRangeAreRefused) {
  EXPECT_THROW(make_host_sync("yoon2021_both", {{"stamps", 0.0}}), ParameterError);
  EXPECT_THROW(make_host_sync("yoon2021_both", {{"latency_estimate", std::string("best")}}),
               ParameterError);
  EXPECT_THROW(make_host_sync("w32time", {{"poll_interval_s", 1.0}}), ParameterError);
}

}  // namespace
}  // namespace simbench
