// Cameras on a coded trigger, from the world to the scores: the sets are right although no host's
// clock is.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench::evaluation {
namespace {

std::vector<Row> scored_coded_rig(std::vector<scenarios::Override> overrides,
                                  const std::vector<std::string>& pipelines) {
  overrides.push_back({"/timeline/frames", "200"});
  const scenarios::Scenario scenario =
      scenarios::load_scenario("18cam_6host_90fps_coded", overrides);
  return evaluate(
             scenario, [&] { return sim::make_simulation(scenario); },
             {.first_seed = 1, .seeds = 2, .jobs = 1, .pipelines = pipelines}, nullptr)
      .rows;
}

TEST(CodedTriggerRig, FindsEverySetAndACommonTime) {
  const Row row = scored_coded_rig({}, {"coded"}).front();
  EXPECT_GT(row.evaluated_pulses, 300);
  EXPECT_EQ(row.precision, 1);
  EXPECT_EQ(row.recall, 1);
  EXPECT_EQ(row.sets.index_errors, 0);
  // The range of 18 stamps of 2.03 us: 3.64 of them.
  EXPECT_NEAR(row.amd_ms.median, 0.0074, 0.0007);
  ASSERT_TRUE(row.search.has_value());
  EXPECT_EQ(row.search->found, 36U);
  EXPECT_LE(row.search->error_probability, 1e-9);
  EXPECT_LT(row.search->seconds, 0.5);
  EXPECT_LT(row.search->since_first_frame_s, 5.6) << "steady after 5 s";
}

TEST(CodedTriggerRig, WithoutAnUnsteadyStartThePlaceIsKnownAtOnce) {
  const Row row = scored_coded_rig({{"/cameras/unstable_start_ms", "0"}}, {"coded_sets"}).front();
  EXPECT_EQ(row.recall, 1);
  EXPECT_LT(row.search->since_first_frame_s, 0.6);
}

TEST(CodedTriggerRig, GenlockAtHalfRateReadsTheCodeToo) {
  for (const char* const code :
       {R"({"kind": "position", "order": 12, "shift_us": 50})",
        R"({"kind": "frequency", "order": 10, "shift_us": 100, "pulses_per_symbol": 2})"}) {
    const Row row = scored_coded_rig({{"/cameras/sync_mode", "genlock"},
                                      {"/trigger/rate_hz", "45"},
                                      {"/trigger/code", code}},
                                     {"coded"})
                        .front();
    EXPECT_EQ(row.precision, 1) << code;
    EXPECT_EQ(row.recall, 1) << code;
    EXPECT_EQ(row.search->found, 36U) << code;
    EXPECT_LT(row.search->seconds, 2) << code;
  }
}

TEST(CodedTriggerRig, StepsOfAutoExposureDoNotMatter) {
  const Row row =
      scored_coded_rig({{"/cameras/auto_exposure/step_interval_exponential_ms", "200"}}, {"coded"})
          .front();
  EXPECT_EQ(row.precision, 1);
  EXPECT_EQ(row.recall, 1);
}

}  // namespace
}  // namespace simbench::evaluation
