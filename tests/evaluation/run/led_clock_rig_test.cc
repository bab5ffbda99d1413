// Cameras that film a clock of LEDs, from the world to the scores.
#include <gtest/gtest.h>

#include <vector>

#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

Row scored_led_rig(std::vector<scenarios::Override> overrides) {
  overrides.push_back({"/timeline/frames", "150"});
  overrides.push_back({"/timeline/warm_up_ms", "5000"});
  overrides.push_back({"/cameras/led_clock/first_ms", "3000"});
  overrides.push_back({"/cameras/led_clock/last_ms", "3000"});
  const scenarios::Scenario scenario = scenarios::load_scenario("25cam_led_30fps", overrides);
  return evaluate(
             scenario, [&] { return sim::make_simulation(scenario); },
             {.first_seed = 1, .seeds = 2, .jobs = 1, .pipelines = {"rocsync_led.hardware_sync"}},
             nullptr)
      .rows.front();
}

// Each middle is wrong by two ends, sigma 0.2 ms; a line averages some of it.
TEST(LedClockRig, AStepLeavesLessThanItsOwnError) {
  const Row row = scored_led_rig({{"/cameras/led_clock/row_spread_share", "0"}});
  EXPECT_GT(row.evaluated_pulses, 100);
  EXPECT_GT(row.rmdv_ms.median, 0.01);
  EXPECT_LT(row.rmdv_ms.median, 0.2);
}

// Rows that are uniform over 5 ms, whose sigma is 1.44 ms.
TEST(LedClockRig, TheRowsOfTheBoardStay) {
  EXPECT_NEAR(scored_led_rig({}).rmdv_ms.median, 1.44, 0.4);
}

}  // namespace
}  // namespace simbench::evaluation
