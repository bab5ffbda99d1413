// Which frames a run expects and misses: where the trigger is too fast for the cameras' mode, and
// where more cameras share a USB controller than it carries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

using scenarios::Override;
using ::testing::Each;
using ::testing::IsNan;
using ::testing::Le;

Results results_of(const std::string& name, const std::vector<Override>& overrides,
                   const std::vector<std::string>& pipelines) {
  const scenarios::Scenario scenario = scenarios::load_scenario(name, overrides);
  return evaluate(
      scenario, [&] { return sim::make_simulation(scenario); },
      {.seeds = 2, .jobs = 1, .pipelines = pipelines, .keep_pulses = true}, nullptr);
}

// Three cameras in a 60 Hz mode, 120 pulses.
TEST(FramesOfARun, GenlockAtTheFullRateIsScoredOverThePulsesThatExpose) {
  const Results results =
      results_of("3cam_1host_30fps", {{"/trigger/rate_hz", "60"}, {"/timeline/frames", "120"}},
                 {"free_running", "oracle", "genlock"});
  ASSERT_EQ(results.rows.size(), 3U);
  for (const Row& row : results.rows) {
    SCOPED_TRACE(row.pipeline);
    EXPECT_EQ(row.frames.expected, 2 * 3 * 60);
    EXPECT_EQ(row.frames.delivered, 2 * 3 * 60);
    EXPECT_EQ(row.frames.dropped, 0);
    EXPECT_EQ(row.evaluated_pulses, 2 * 60);
    EXPECT_EQ(row.sets.index_errors, 0);
    EXPECT_DOUBLE_EQ(row.precision, 1);
    EXPECT_DOUBLE_EQ(row.recall, 1);
    for (const SeedScore& seed : row.seeds) {
      EXPECT_EQ(seed.genlock_index_errors, 0);
      ASSERT_EQ(seed.pulses.size(), 60U);
      for (std::size_t i = 1; i < seed.pulses.size(); ++i) {
        EXPECT_EQ(seed.pulses[i].pulse - seed.pulses[i - 1].pulse, 2);
      }
    }
  }
  // Perfect stamps differ by what the exposures differ; one host's are alike.
  EXPECT_THAT(results.rows[1].amd_ms.values, Each(Le(1.0)));
}

TEST(FramesOfARun, SixCamerasOnAControllerLoseOneFrameInSix) {
  for (const int cameras : {3, 4, 6}) {
    SCOPED_TRACE(testing::Message() << cameras << " on a controller");
    const Row row = results_of("18cam_1host_pcie",
                               {{"/timeline/frames", "60"},
                                {"/usb/cameras_per_controller", std::to_string(cameras)}},
                               {"oracle"})
                        .rows.at(0);
    EXPECT_EQ(row.frames.expected, 2 * 18 * 60);
    EXPECT_EQ(row.frames.dropped, cameras == 6 ? row.frames.expected / 6 : 0);
    EXPECT_EQ(row.evaluated_pulses, cameras == 6 ? 0 : 2 * 60);
    if (cameras == 6) {
      EXPECT_THAT(row.amd_ms.values, Each(IsNan())) << "no pulse is complete";
    }
  }
}

}  // namespace
}  // namespace simbench::evaluation
