#include "evaluation/clock_run/clock_causes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sim/rig/clock_simulation.h"

namespace simbench::evaluation {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::Not;

// Three hosts over a quiet network, twenty minutes of two_way_hull.
ClockCauses causes_in(std::vector<scenarios::Override> sets) {
  sets.insert(sets.begin(), {{"/hosts/count", "3"},
                             {"/cameras/count", "3"},
                             {"/cameras/cameras_per_host", "1"},
                             {"/network/latency_exponential_ms", "0.001"},
                             {"/pipelines",
                              R"([{"name": "a", "host_sync": "two_way_hull",
                                   "device_time": "raw_arrival", "gathering": "yoon2021"}])"}});
  const scenarios::Scenario scenario = scenarios::load_scenario("6host_star", sets);
  return clock_causes(
      scenario, "a",
      [](const scenarios::Scenario& world) { return sim::make_clock_simulation(world); },
      {.duration_s = 1200, .from_s = 300, .seeds = 2, .jobs = 1}, nullptr);
}

std::vector<std::string> found_in(const ClockCauses& causes) {
  std::vector<std::string> names;
  for (const ClockCause& cause : causes.found) names.push_back(cause.what);
  return names;
}

// The master's clock too (a bug report: offsets of a PTP network that jump now and then).
TEST(ClockCauses, AStepIsTheCauseOfWhatAStepMade) {
  for (const int host : {0, 1}) {
    SCOPED_TRACE(host);
    const ClockCauses causes = causes_in(
        {{"/faults", R"([{"kind": "clock_step", "at_ms": 600000, "step_ms": 140000, "host": )" +
                         std::to_string(host) + "}]"}});
    ASSERT_THAT(causes.found, Not(IsEmpty()));
    EXPECT_EQ(causes.found.front().what, "the step of a clock");
    EXPECT_NEAR(causes.found.front().largest_from_ms, 140000, 1);
    EXPECT_LT(causes.found.front().largest_to_ms, 1);
    EXPECT_EQ(causes.found.front().sets.front().pointer, "/faults");
  }
}

// A link 0.2 ms longer one way than the other puts its slave half of that off.
TEST(ClockCauses, UnequalPathsAreTheCauseOfWhatTheyMade) {
  const ClockCauses causes =
      causes_in({{"/network/links", R"([{"host": 1, "asymmetry_ms": 0.2}])"}});
  ASSERT_THAT(causes.found, Not(IsEmpty()));
  EXPECT_EQ(causes.found.front().what, "paths that are unequal there and back");
  EXPECT_NEAR(causes.found.front().spread_from_ms, 0.1, 0.02);
  EXPECT_LT(causes.found.front().spread_to_ms, 0.02);
}

TEST(ClockCauses, WhatDidNotHappenIsNotAsked) {
  const ClockCauses causes = causes_in({});
  EXPECT_THAT(causes.tried, Not(IsEmpty()));
  for (const char* absent :
       {"the step of a clock", "the leap second", "hosts and links that stopped"}) {
    EXPECT_THAT(causes.tried, Not(Contains(absent)));
    EXPECT_THAT(found_in(causes), Not(Contains(absent)));
  }
}

TEST(ClockCauses, LongWorldsAreNotAsked) {
  const scenarios::Scenario scenario = scenarios::load_scenario("6host_star");
  const ClockCauses causes = clock_causes(
      scenario, scenario.pipelines.front().name,
      [](const scenarios::Scenario& world) { return sim::make_clock_simulation(world); },
      {.duration_s = 10'000'000, .seeds = 2}, nullptr);
  EXPECT_THAT(causes.tried, IsEmpty());
}

}  // namespace
}  // namespace simbench::evaluation
