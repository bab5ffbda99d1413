#include "evaluation/levers/levers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "evaluation/answer/answer.h"
#include "evaluation/levers/rig_changes.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

using scenarios::Override;
using scenarios::Scenario;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::unique_ptr<RecordingSource> lever_world(const Scenario& scenario) {
  return sim::make_simulation(scenario);
}

Results lever_run(const Scenario& scenario, const std::vector<std::string>& pipelines = {}) {
  return evaluate(
      scenario, [&] { return lever_world(scenario); },
      {.seeds = 8, .jobs = 2, .pipelines = pipelines, .share_captures = true}, nullptr);
}

// Two hosts of two cameras each, for a second.
Scenario small(std::vector<Override> sets) {
  sets.insert(sets.begin(), {{"/hosts/count", "2"},
                             {"/cameras/count", "4"},
                             {"/cameras/cameras_per_host", "2"},
                             {"/timeline/frames", "60"},
                             {"/timeline/warm_up_ms", "1000"}});
  return scenarios::load_scenario("18cam_6host_45fps_lan", sets);
}

std::string one_pipeline(const char* host_sync, const char* device_time) {
  return std::string(R"([{"name": "mine", "host_sync": ")") + host_sync + R"(", "device_time": ")" +
         device_time + R"(", "gathering": "yoon2021"}])";
}

struct Found {
  Scenario scenario;
  Results results;
  Levers levers;
};

Found find(const Scenario& scenario) {
  Found found{.scenario = scenario, .results = lever_run(scenario), .levers = {}};
  found.levers = find_levers(scenario, found.results, *best_of(found.results), lever_world,
                             {.jobs = 2}, nullptr)
                     .value();
  return found;
}

// Adds the lever's options to the run, as a user would.
Row run_of(const Lever& lever, const Found& found) {
  std::vector<Override> sets = lever.sets;
  const auto is_known =
      std::ranges::count(found.scenario.pipelines, lever.pipeline, &scenarios::Pipeline::name) > 0;
  if (!is_known) {
    const std::size_t first = lever.pipeline.find('+');
    const std::size_t second = lever.pipeline.find('+', first + 1);
    sets.push_back({"/pipelines/-", R"({"name": ")" + lever.pipeline + R"(", "host_sync": ")" +
                                        lever.pipeline.substr(0, first) + R"(", "device_time": ")" +
                                        lever.pipeline.substr(first + 1, second - first - 1) +
                                        R"(", "gathering": ")" + lever.pipeline.substr(second + 1) +
                                        R"("})"});
  }
  const Scenario changed =
      scenarios::load_scenario_text(found.scenario.resolved_json(), found.scenario.name, sets);
  return lever_run(changed, {lever.pipeline}).rows.front();
}

// The paper's method where a better one costs nothing.
TEST(Levers, AreWhatAUserWouldFind) {
  const Found found = find(small({{"/pipelines", one_pipeline("yoon2021_both", "regression_30")}}));
  ASSERT_THAT(found.levers.effective, Not(IsEmpty()));
  EXPECT_EQ(found.levers.seeds, 8u);
  EXPECT_GT(found.levers.algorithms, 40u);
  for (const Lever& lever : found.levers.effective) {
    SCOPED_TRACE(lever.what);
    EXPECT_LT(lever.to, lever.from);
    EXPECT_EQ(run_of(lever, found).amd_ms.median, lever.to) << "to the bit";
    EXPECT_EQ(found.results.rows.front().amd_ms.median, lever.from);
  }
}

// Exposures beyond the frame period lose half of the pulses; shorter ones find them.
TEST(Levers, LostPulsesComeFirst) {
  const Found found =
      find(small({{"/cameras/exposure_ms", "25"}, {"/cameras/exposure_camera_periods", "0"}}));
  ASSERT_THAT(found.levers.effective, Not(IsEmpty()));
  const Lever& first = found.levers.effective.front();
  EXPECT_THAT(first.what, HasSubstr("exposures of 12.5 ms in place of 25"));
  EXPECT_GT(first.missing_from, 0.4);
  EXPECT_EQ(first.missing_to, 0);
}

// Nothing is wrong with ideal clocks, exposures and deliveries.
TEST(Levers, NothingHelpsWhereNothingIsWrong) {
  const Scenario ideal = small({{"/pipelines", one_pipeline("two_way_hull", "hull_switch_10s")},
                                {"/network/latency_exponential_ms", "0"},
                                {"/network/asymmetry_sigma_ms", "0"},
                                {"/cameras/exposure_camera_periods", "0"},
                                {"/usb/cameras_per_controller", "1"},
                                {"/usb/delivery_jitter_transfers", "0"},
                                {"/usb/host_jitter_transfers", "0"},
                                {"/usb/kernel_copy_exponential_ms", "0"},
                                {"/usb/spike_probability", "0"},
                                {"/cameras/sensor_stamp_jitter_sigma_us", "0"}});
  for (const Lever& lever : find(ideal).levers.effective) {
    EXPECT_LT(lever.from, 0.02) << lever.what << ": from microseconds to fewer";
  }
}

TEST(Levers, LargeWorldsAreNotSearched) {
  const Scenario scenario = small({});
  const Results results = lever_run(scenario);
  EXPECT_FALSE(
      find_levers(scenario, results, *best_of(results), lever_world, {.most_events = 10}, nullptr)
          .has_value());
}

TEST(RigChanges, AreThoseThatChangeSomething) {
  const auto names = [](const Scenario& scenario) {
    std::string all;
    for (const RigChange& change : rig_changes(scenario)) all += change.what + "; ";
    return all;
  };
  const std::string of_six = names(scenarios::load_scenario("18cam_6host_45fps_lan"));
  EXPECT_THAT(of_six, HasSubstr("ptp_cards"));
  EXPECT_THAT(of_six, HasSubstr("cameras in the mode full_slave"));
  EXPECT_THAT(of_six, HasSubstr("a USB controller for each camera"));
  const std::string of_one = names(scenarios::load_scenario("3cam_1host_30fps"));
  EXPECT_THAT(of_one, Not(HasSubstr("ptp_cards"))) << "one host has nothing to synchronise with";
  const Scenario equal = small({{"/cameras/exposure_camera_periods", "0"}});
  EXPECT_THAT(names(equal), Not(HasSubstr("equal exposures")));
}

}  // namespace
}  // namespace simbench::evaluation
