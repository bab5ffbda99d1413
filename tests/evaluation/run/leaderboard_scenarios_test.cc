// The leaderboards leave nobody out.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "algorithms/device_time/variants.h"
#include "algorithms/registry.h"
#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

class LeaderboardScenario : public testing::TestWithParam<const char*> {};

TEST_P(LeaderboardScenario, HasEveryHostSyncAndEveryDeviceTime) {
  const scenarios::Scenario scenario = scenarios::load_scenario(GetParam());
  EXPECT_NO_THROW(check_pipelines(scenario));
  EXPECT_EQ(scenario.evaluation.table, scenarios::TableKind::kLeaderboard);
  std::set<std::string> host_syncs;
  std::set<std::string> device_times;
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    if (pipeline.name.starts_with("host.")) host_syncs.insert(pipeline.host_sync);
    if (!pipeline.name.starts_with("device.")) continue;
    device_times.insert(parse_device_time_name(pipeline.device_time).base);
  }
  for (const HostSyncEntry& entry : nonempty(algorithms<HostSyncEntry>())) {
    if (entry.info.family.starts_with("test_")) continue;  // of another test
    if (entry.info.name == "ntp_first_run") continue;      // as ntp, where no host has a drift file
    if (entry.info.name.starts_with("wifi_")) continue;    // its hosts have no radios
    EXPECT_TRUE(host_syncs.contains(entry.info.name)) << entry.info.name;
  }
  for (const DeviceTimeEntry& entry : nonempty(algorithms<DeviceTimeEntry>())) {
    if (entry.info.family.starts_with("test_")) continue;  // of another test
    // Its cameras have clocks of their own, and see no other; its trigger has no code.
    const bool is_of_other_worlds = entry.info.name == "host_stamps" ||
                                    entry.info.name == "rocsync_led" || entry.info.name == "coded";
    EXPECT_NE(device_times.contains(entry.info.name), is_of_other_worlds) << entry.info.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Builtin, LeaderboardScenario,
                         testing::Values("leaderboard_lan", "leaderboard_lan_ideal_calibration",
                                         "leaderboard_calibrated"));

TEST(LeaderboardGathering, HasEveryGathering) {
  const scenarios::Scenario scenario = scenarios::load_scenario("leaderboard_gathering");
  std::set<std::string> gatherings;
  for (const scenarios::Pipeline& pipeline : scenario.pipelines) {
    gatherings.insert(pipeline.gathering);
  }
  for (const GatheringEntry& entry : nonempty(algorithms<GatheringEntry>())) {
    // The one needs a code, the other has the sets of yoon2021 that are sure.
    const bool is_apart = entry.info.name == "coded_trigger" || entry.info.name == "certified";
    EXPECT_NE(gatherings.contains(entry.info.name), is_apart) << entry.info.name;
  }
}

}  // namespace
}  // namespace simbench::evaluation
