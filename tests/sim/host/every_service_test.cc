// What every client of a server has to do, whatever its loop: a page of named limits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/host_sync/chrony/chrony.h"
#include "algorithms/host_sync/ntp/ntp_service.h"
#include "tests/nonempty.h"
#include "tests/sim/host/service_scenarios.h"
#include "tests/sim/host/service_world.h"

namespace simbench::sim {
namespace {

constexpr double kHour = 3600;  // s

struct ServiceLimits {
  std::string name;
  std::function<std::unique_ptr<HostSync>()> make;
  std::function<scenarios::Scenario()> world;     // with jitter
  std::function<scenarios::Scenario()> constant;  // with constant latencies
  // A server that never answers is one outcome, which says so.
  double silent_s = 2 * kHour;
  std::string silent_message = "no valid packet";
  // Three slaves must be this good, with loss, duplicates and reordering.
  double lossy_s = 12 * kHour;
  double lossy_error_s = 20e-3;
  // An asymmetry that no stamp shows; 0: not tried, without two-way stamps nothing is seen.
  double asymmetry_ms = 0;
  std::uint64_t asymmetry_seed = 1;
  double asymmetry_s = 24 * kHour;
  double asymmetry_seen_s = 5e-6;    // at most
  double asymmetry_error_s = 10e-6;  // at least
};

ServiceLimits ntp_limits(const std::string& name, NtpMode mode) {
  return {.name = name,
          .make =
              [mode] {
                NtpSettings settings;
                settings.mode = mode;
                return std::make_unique<NtpService>(settings);
              },
          .world = lan_world,
          .constant = quiet_world};
}

std::vector<ServiceLimits> service_page() {
  ServiceLimits unicast = ntp_limits("Ntp", NtpMode::kUnicast);
  unicast.asymmetry_ms = 0.5;
  unicast.asymmetry_seed = 2;
  return {unicast,
          ntp_limits("NtpBroadcastVolley", NtpMode::kBroadcastVolley),
          ntp_limits("NtpBroadcastFixed", NtpMode::kBroadcastFixed),
          {.name = "Chrony",
           .make = [] { return std::make_unique<ChronyService>(ChronySettings{}); },
           .world = [] { return chrony_world(1e-4, 1e-9); },
           .constant = [] { return chrony_world(0, 0); },
           .silent_s = kHour,
           .silent_message = "no valid reply",
           .lossy_s = 10'000,
           .lossy_error_s = 1e-3,
           .asymmetry_ms = 0.2,
           .asymmetry_seed = 3,
           .asymmetry_s = kHour,
           .asymmetry_seen_s = 1e-6,
           .asymmetry_error_s = 5e-6}};
}

class EveryServiceTest : public testing::TestWithParam<ServiceLimits> {};

TEST_P(EveryServiceTest, ASilentServerIsAnOutcome) {
  scenarios::Scenario scenario = GetParam().constant();
  scenario.network.loss_probability = 1;
  ServiceWorld world(scenario);
  const auto service = GetParam().make();
  world.start(*service);
  world.run_until(GetParam().silent_s);
  ASSERT_EQ(world.record.outcomes.size(), 1U);
  EXPECT_FALSE(world.record.outcomes[0].synchronised);
  EXPECT_NE(world.record.outcomes[0].message.find(GetParam().silent_message), std::string::npos);
}

TEST_P(EveryServiceTest, ReportsOnceAndSurvivesLossDuplicatesAndReordering) {
  scenarios::Scenario scenario = GetParam().world();
  scenario.hosts.count = 4;
  scenario.network.loss_probability = 0.3;
  scenario.network.duplicate_probability = 0.2;
  scenario.network.reorder_probability = 0.2;
  scenario.network.reorder_max_ms = 2;
  ServiceWorld world(scenario);
  const auto service = GetParam().make();
  world.start(*service);
  world.run_until(GetParam().lossy_s);
  EXPECT_EQ(world.record.outcomes.size(), 3U);
  for (const SyncOutcome& outcome : world.record.outcomes) EXPECT_TRUE(outcome.synchronised);
  for (const std::size_t slave : {1, 2, 3}) {
    EXPECT_LT(std::abs(world.error_s(slave)), GetParam().lossy_error_s) << "slave " << slave;
  }
}

INSTANTIATE_TEST_SUITE_P(Services, EveryServiceTest, testing::ValuesIn(service_page()),
                         [](const auto& service) { return service.param.name; });

TEST(ServiceAsymmetryTest, IsTheFloor) {
  std::vector<ServiceLimits> page = service_page();
  std::erase_if(page, [](const ServiceLimits& limits) { return limits.asymmetry_ms == 0; });
  for (const ServiceLimits& limits : nonempty(page)) {
    SCOPED_TRACE(limits.name);
    scenarios::Scenario scenario = limits.constant();
    scenario.network.asymmetry_sigma_ms = limits.asymmetry_ms;
    ServiceWorld world(scenario, limits.asymmetry_seed);
    const auto service = limits.make();
    world.start(*service);
    world.run_until(limits.asymmetry_s);
    ASSERT_FALSE(world.record.exchanges.empty());
    const Exchange& last = world.record.exchanges.back().second;
    // What the stamps show is nothing: the error is invisible to them.
    const double seen_s = to_seconds((*last.t2 - *last.t1) + (*last.t3 - *last.t4)) / 2;
    EXPECT_NEAR(seen_s, 0, limits.asymmetry_seen_s);
    EXPECT_GT(std::abs(world.error_s(1)), limits.asymmetry_error_s);
  }
}

}  // namespace
}  // namespace simbench::sim
