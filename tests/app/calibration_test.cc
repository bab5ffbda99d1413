// What calibrations do to the errors of calibrated device times, in simulated leaderboards.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "evaluation/run/evaluate.h"
#include "scenarios/loader.h"
#include "sim/rig/simulation.h"

namespace simbench {
namespace {

struct Errors {
  double bias_ms = 0;
  double absolute_ms = 0;
};

std::map<std::string, Errors> errors_of(const std::string& name,
                                        const std::vector<scenarios::Override>& overrides = {}) {
  const scenarios::Scenario scenario = scenarios::load_scenario(name, overrides);
  const evaluation::Results results = evaluation::evaluate(
      scenario, [&] { return sim::make_simulation(scenario); },
      {.first_seed = 1,
       .seeds = 8,
       .jobs = 1,
       .pipelines = {"device.two_way_poll_calibrated", "device.hull_switch_10s_calibrated",
                     "device.hull_switch_10s_sdk_calibrated", "device.regression_30_calibrated",
                     "device.regression_30_sdk_calibrated"}},
      {});
  std::map<std::string, Errors> errors;
  for (const evaluation::Row& row : results.rows) {
    errors[row.pipeline.substr(row.pipeline.find('.') + 1)] = {row.bias_ms.median,
                                                               row.absolute_error_ms.median};
  }
  return errors;
}

// A right calibration leaves what the estimator itself is wrong by: a hull little, a regression the
// mean of the jitter.
void expect_no_bias(std::map<std::string, Errors> errors) {
  EXPECT_NEAR(errors["two_way_poll_calibrated"].bias_ms, 0, 0.005);
  EXPECT_NEAR(errors["hull_switch_10s_calibrated"].bias_ms, 0, 0.1);
}

TEST(IdealCalibration, LeavesNoBias) {
  expect_no_bias(errors_of("leaderboard_lan_ideal_calibration"));
}

// In another world the calibration is another one: it was 3 and 12 ms off when it was a constant.
TEST(IdealCalibration, FollowsTheRate) {
  for (const auto& [rate_hz, mode_hz] : {std::pair("30", "60"), std::pair("15", "30")}) {
    SCOPED_TRACE(mode_hz);
    expect_no_bias(
        errors_of("leaderboard_lan_ideal_calibration",
                  {{"/trigger/rate_hz", rate_hz}, {"/cameras/streams/0/mode_rate_hz", mode_hz}}));
  }
}

TEST(IdealCalibration, FollowsTheImageSize) {
  expect_no_bias(
      errors_of("leaderboard_lan_ideal_calibration",
                {{"/cameras/streams/0/width", "640"}, {"/cameras/streams/0/height", "360"}}));
}

TEST(RealCalibration, CostsAnErrorThatTheIdealOneHides) {
  auto ideal = errors_of("leaderboard_lan_ideal_calibration");
  auto real = errors_of("leaderboard_lan");
  // Half of an asymmetry that is wrong by N(0.1 ms): a median of 0.034 ms.
  EXPECT_LT(ideal["two_way_poll_calibrated"].absolute_ms, 0.01);
  EXPECT_GT(real["two_way_poll_calibrated"].absolute_ms, 0.01);
  EXPECT_LT(real["two_way_poll_calibrated"].absolute_ms, 0.1);
  EXPECT_GT(real["hull_switch_10s_calibrated"].absolute_ms,
            ideal["hull_switch_10s_calibrated"].absolute_ms);
}

// Whole milliseconds cost a hull more than a regression, which averages over them.
TEST(SdkStamps, AreWorseThanTheNodesOwn) {
  auto errors = errors_of("leaderboard_lan_ideal_calibration");
  EXPECT_GT(errors["hull_switch_10s_sdk_calibrated"].absolute_ms,
            1.5 * errors["hull_switch_10s_calibrated"].absolute_ms);
  EXPECT_NEAR(errors["regression_30_sdk_calibrated"].bias_ms,
              errors["regression_30_calibrated"].bias_ms, 0.05);
}

}  // namespace
}  // namespace simbench
