// Importance splitting of simulated worlds beside brute force.
#include "app/rare_sets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenarios/loader.h"

namespace simbench::app {
namespace {

// Two hosts with two cameras each, 60 pulses a run; spreads by the jitter of polls and clocks.
scenarios::Scenario small_world() {
  return scenarios::load_scenario("leaderboard_lan", {{"/hosts/count", "2"},
                                                      {"/cameras/count", "4"},
                                                      {"/cameras/cameras_per_host", "2"},
                                                      {"/timeline/frames", "60"}});
}

constexpr const char* kPipeline = "host.ptp_e2e_software";

TEST(RareSets, ARunIsAFunctionOfItsNumbers) {
  const scenarios::Scenario scenario = small_world();
  const auto run = rare_sets(scenario, kPipeline, RareEvent::kSpread, 0.01);
  const evaluation::RareScore first = run({.seed = 7});
  EXPECT_EQ(run({.seed = 7}).level, first.level);
  EXPECT_NE(run({.seed = 8}).level, first.level);
  EXPECT_NE(run({.seed = 7, .changes = {{.key = 1, .share = 0.5}}}).level, first.level);
  EXPECT_GT(first.level, 0);
}

TEST(RareSets, AreNearBruteForce) {
  const scenarios::Scenario scenario = small_world();
  constexpr double kBoundMs = 0.065;
  const auto run = rare_sets(scenario, kPipeline, RareEvent::kSpread, kBoundMs);
  const evaluation::SplittingOptions options{.bound = kBoundMs};
  const auto split = evaluation::estimate_rare(run, options, nullptr);
  const auto counted = evaluation::count_rare(run, 40000, options, nullptr);
  ASSERT_FALSE(split.is_below);
  EXPECT_LT(std::abs(std::log(split.probability / counted.probability)), std::log(1.5))
      << split.probability << " beside " << counted.probability;
  EXPECT_LE(split.low, counted.high);
  EXPECT_GE(split.high, counted.low);
}

}  // namespace
}  // namespace simbench::app
