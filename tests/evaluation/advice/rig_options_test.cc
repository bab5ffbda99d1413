#include "evaluation/advice/rig_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "scenarios/loader.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<scenarios::Pipeline> kOraclePipeline = {
    {.name = "mine", .host_sync = "oracle", .device_time = "oracle", .gathering = "yoon2021"}};

std::string refused(const RigRequest& request) {
  try {
    (void)rig_options(request);
  } catch (const scenarios::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RigOptions, AreInTheOrderOfTheirPrice) {
  const RigRequest request{.cameras = 24, .rate_hz = 60, .fewest_hosts = 2, .most_hosts = 8};
  const auto options = rig_options(request);
  EXPECT_TRUE(std::ranges::is_sorted(
      options, {}, [](const RigOption& option) { return option.price.middle_eur(); }));
  for (const RigOption& option : nonempty(options)) {
    EXPECT_GE(option.hosts, 2);
    EXPECT_LE(option.hosts, 8);
    EXPECT_GE(option.hosts * option.cameras_per_host, 24);
    EXPECT_LE(option.cameras_per_host,
              option.host.cameras + option.cards_per_host * option.usb_card.cameras);
    EXPECT_LE(option.cards_per_host, option.host.slots);
    EXPECT_GE(option.network_switch.hosts, option.hosts);
  }
}

// Cameras that are hosts need no USB, and a computer where they have none.
TEST(RigOptions, CamerasThatAreHostsBringTheirOwnClocks) {
  for (const auto& [name, cameras, hosts] :
       {std::tuple{"gige_ace", 6, 7U}, {"oak_4", 4, 5U}, {"raspberry_camera_v3", 8, 8U}}) {
    SCOPED_TRACE(name);
    RigRequest request{.camera = name, .cameras = cameras, .rate_hz = 30};
    for (const RigOption& option : nonempty(rig_options(request))) {
      EXPECT_EQ(option.cards, 0);
      EXPECT_THAT(option.name(), HasSubstr(name));
      const scenarios::Scenario world = scenario_of(option, request, kOraclePipeline);
      EXPECT_EQ(world.hosts.count, hosts);
      EXPECT_TRUE(world.cameras.frame_control);
    }
    request.cameras = 100;
    EXPECT_THAT(refused(request), HasSubstr("what a switch has ports for"));
    request.rate_hz = 31;
    EXPECT_THAT(refused(request), HasSubstr("--rate: found 31"));
  }
  EXPECT_THAT(refused({.camera = "webcam"}),
              HasSubstr("--camera: found 'webcam', allowed: d455, "));
}

TEST(RigOptions, ASwitchWithTransparentClocksIsOfUseToCamerasWithPtp) {
  const auto switches = [](const char* camera) {
    std::vector<std::string> names;
    for (const RigOption& option : rig_options({.camera = camera, .cameras = 4, .rate_hz = 30})) {
      names.push_back(option.network_switch.part);
    }
    return names;
  };
  EXPECT_THAT(switches("gige_ace"), ElementsAre("office_switch", "ptp_switch"));
  EXPECT_THAT(switches("raspberry_camera_v3"), ElementsAre("office_switch"));
}

TEST(RigOptions, AWorldHasWhatItsPartsSet) {
  const RigRequest request{.cameras = 12, .rate_hz = 60, .fewest_hosts = 4, .most_hosts = 4};
  int seen = 0;
  for (const RigOption& option : nonempty(rig_options(request))) {
    const scenarios::Scenario world = scenario_of(option, request, kOraclePipeline);
    EXPECT_EQ(world.hosts.count, 4U);
    EXPECT_EQ(world.cameras.count, 12U);
    EXPECT_EQ(world.hosts.nic.hardware_stamps, option.clock.part == "ptp_cards");
    EXPECT_EQ(world.hosts.pulse_lines.trigger, option.clock.part == "trigger_wires");
    EXPECT_EQ(world.network.switch_clock == scenarios::SwitchClockKind::kTransparent,
              option.network_switch.part == "ptp_switch");
    ++seen;
  }
  EXPECT_EQ(seen, 6) << "five clocks with an office switch, cards also with a PTP switch";
}

TEST(RigOptions, OfOneHostNeedNoNetwork) {
  const RigRequest request{.cameras = 3, .rate_hz = 30, .fewest_hosts = 1, .most_hosts = 1};
  const auto options = rig_options(request);
  ASSERT_EQ(options.size(), 1U);
  EXPECT_EQ(options[0].name(), "1 x office_pc");
  EXPECT_THAT(options[0].host_sync(), ElementsAre("free_running"));
  EXPECT_EQ(options[0].price.low_eur, 400);
}

TEST(RigOptions, TakeCardsAndBiggerHostsWhereTheyAreNeeded) {
  const auto cheapest = [](std::int64_t cameras) {
    return rig_options({.cameras = cameras, .fewest_hosts = 1, .most_hosts = 1}).front().name();
  };
  EXPECT_EQ(cheapest(4), "1 x office_pc, 1 x usb_card_single");
  EXPECT_EQ(cheapest(7), "1 x office_pc, 1 x usb_card_quad");
  EXPECT_EQ(cheapest(8), "1 x workstation, 2 x usb_card_single");
}

TEST(RigOptions, TheRateDecidesTheSyncMode) {
  EXPECT_THAT(supported_rates_hz("d455"), ElementsAre(7.5, 15, 30, 45, 60, 90));
  const auto mode = [](double rate_hz) {
    const RigRequest request{.cameras = 3, .rate_hz = rate_hz, .most_hosts = 1};
    return scenario_of(rig_options(request).front(), request, kOraclePipeline).cameras.sync_mode;
  };
  EXPECT_EQ(mode(45), scenarios::SyncMode::kGenlock);
  EXPECT_EQ(mode(60), scenarios::SyncMode::kSlave);
}

TEST(RigOptions, RefuseWhatNoWorldSupports) {
  EXPECT_THAT(refused({.cameras = 3, .rate_hz = 61}), HasSubstr("--rate: found 61, allowed 7.5"));
  EXPECT_THAT(refused({.cameras = 3, .fewest_hosts = 4, .most_hosts = 8}),
              HasSubstr("--hosts: found 4..8, allowed at most a host for each of the 3 cameras"));
  EXPECT_THAT(refused({.cameras = 100, .fewest_hosts = 1, .most_hosts = 1}),
              HasSubstr("--cameras: found 100 on 1 to 1 hosts"));
}

TEST(RigOptions, HaveThePartsOfTheUser) {
  scenarios::Part cheap = *scenarios::find_part("office_pc");
  cheap.part = "cheap_pc";
  cheap.prices[0].range = {1, 2};
  const auto options = rig_options({.cameras = 3, .most_hosts = 1, .more_parts = {cheap}});
  EXPECT_EQ(options.front().name(), "1 x cheap_pc");
}

}  // namespace
}  // namespace simbench::evaluation
