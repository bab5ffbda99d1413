#include "evaluation/budget/budget.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "scenarios/loader.h"
#include "sim/rig/simulation.h"
#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

// Two hosts of one camera each, in a world whose only faults are the ones given.
scenarios::Scenario small_world(const std::string& set_pointer, const std::string& value) {
  return scenarios::load_scenario("18cam_6host_45fps_lan",
                                  {{"/hosts/count", "2"},
                                   {"/cameras/count", "2"},
                                   {"/cameras/cameras_per_host", "1"},
                                   {"/timeline/frames", "40"},
                                   {"/timeline/warm_up_ms", "200"},
                                   {"/cameras/unstable_start_jitter_sigma_ms", "0"},
                                   {set_pointer, value}});
}

std::vector<Budget> budgets_of(const scenarios::Scenario& scenario,
                               const std::vector<scenarios::Pipeline>& pipelines) {
  return error_budgets(
      scenario, pipelines,
      [](const scenarios::Scenario& world) { return sim::make_simulation(world); },
      {.seeds = 2, .jobs = 1}, nullptr);
}

Budget budget_of(const scenarios::Scenario& scenario, const scenarios::Pipeline& pipeline) {
  return budgets_of(scenario, {pipeline}).front();
}

void expect_sum(const ErrorParts& error) {
  for (std::size_t seed = 0; seed < nonempty(error.total.values).size(); ++seed) {
    double sum = error.remainder.values[seed];
    for (const BudgetPart& stage : error.stages) sum += stage.values[seed];
    EXPECT_NEAR(sum, error.total.values[seed], 1e-9) << "seed " << seed + 1;
  }
}

double stage_mean(const ErrorParts& error, BudgetStage stage) {
  return error.stages[static_cast<std::size_t>(stage)].mean;
}

TEST(Budget, PartsAddUpAndNothingIsLeft) {
  const scenarios::Scenario scenario = small_world("/hosts/count", "2");
  const Budget budget = budget_of(scenario, {"both", "yoon2021_both", "regression_30", "yoon2021"});
  EXPECT_TRUE(budget.amd_of_sets);
  expect_sum(budget.amd_ms);
  expect_sum(budget.absolute_error_ms);
  expect_sum(budget.physical_ms);
  // With everything ideal a microsecond of the camera's register and of the fit remains.
  EXPECT_LT(budget.amd_ms.remainder.mean, 0.003);
  EXPECT_LT(budget.absolute_error_ms.remainder.mean, 0.003);
  // The latency of the delivery goes straight into the stamps of a one-way method.
  EXPECT_GT(stage_mean(budget.absolute_error_ms, BudgetStage::kUsbDelivery), 10);
  EXPECT_GT(stage_mean(budget.amd_ms, BudgetStage::kHostClock), 0);
}

void expect_equal_parts(const ErrorParts& a, const ErrorParts& b) {
  EXPECT_EQ(a.total.values, b.total.values);
  EXPECT_EQ(a.remainder.values, b.remainder.values);
  for (std::size_t stage = 0; stage < kStageCount; ++stage) {
    EXPECT_EQ(a.stages[stage].values, b.stages[stage].values) << kStageNames[stage];
  }
}

// An error of the delays' calibration gives an ideal delivery captures of its own, here one below a
// nanosecond; without it the delivery shares those of the real one.
TEST(Budget, SharedCapturesGiveTheSameNumbers) {
  const scenarios::Pipeline pipeline = {"both", "yoon2021_both", "regression_30", "yoon2021"};
  const char* const error = "/cameras/calibration/delay_error_sigma_ms";
  const Budget shared = budget_of(small_world(error, "0"), pipeline);
  const Budget apart = budget_of(small_world(error, "1e-9"), pipeline);
  expect_equal_parts(shared.amd_ms, apart.amd_ms);
  expect_equal_parts(shared.absolute_error_ms, apart.absolute_error_ms);
  expect_equal_parts(shared.physical_ms, apart.physical_ms);
}

// A request that takes 1 ms longer than the reply puts each poll half of that too early.
TEST(Budget, PollsAreAStageOfWhatUsesThem) {
  scenarios::Scenario scenario = small_world("/cameras/clock_poll/interval_ms", "100");
  scenario.cameras.clock_poll.request_ms = 1.2;
  scenario.cameras.clock_poll.reply_ms = 0.2;
  const std::vector<Budget> budgets =
      budgets_of(scenario, {{"polls", "oracle", "two_way_poll", "yoon2021"},
                            {"arrivals", "oracle", "regression_30", "yoon2021"}});
  EXPECT_EQ(budget_stages(budgets[0]).size(), kCommonStages + 1);
  EXPECT_NEAR(stage_mean(budgets[0].absolute_error_ms, BudgetStage::kPolls), 0.5, 0.1);
  EXPECT_NEAR(stage_mean(budgets[0].absolute_error_ms, BudgetStage::kUsbDelivery), 0, 1e-6);
  EXPECT_EQ(budget_stages(budgets[1]).size(), kCommonStages);
  EXPECT_EQ(stage_mean(budgets[1].absolute_error_ms, BudgetStage::kPolls), 0);
}

// Two draw loads of their own and share ideal host clocks, the third is their world's own oracle.
TEST(Budget, PipelinesTogetherHaveTheBudgetsOfEachAlone) {
  const scenarios::Scenario scenario =
      small_world("/hosts/send_cost_session_exponential_ms", "0.2");
  ASSERT_TRUE(scenario.draws_load());
  const std::vector<scenarios::Pipeline> pipelines = {
      {"both", "yoon2021_both", "regression_30", "yoon2021"},
      {"network", "yoon2021_network", "raw_arrival", "yoon2021"},
      {"oracle", "oracle", "regression_30", "oracle"}};
  const std::vector<Budget> together = budgets_of(scenario, pipelines);
  ASSERT_EQ(together.size(), pipelines.size());
  for (std::size_t i = 0; i < pipelines.size(); ++i) {
    SCOPED_TRACE(pipelines[i].name);
    const Budget alone = budget_of(scenario, pipelines[i]);
    EXPECT_EQ(together[i].pipeline, pipelines[i].name);
    EXPECT_EQ(together[i].amd_of_sets, alone.amd_of_sets);
    expect_equal_parts(together[i].amd_ms, alone.amd_ms);
    expect_equal_parts(together[i].absolute_error_ms, alone.absolute_error_ms);
    expect_equal_parts(together[i].physical_ms, alone.physical_ms);
  }
}

TEST(Budget, ALateBranchIsPhysicalAndTheTriggersAlone) {
  const scenarios::Scenario scenario = small_world("/trigger/cable_delay_max_us", "3000");
  const Budget budget = budget_of(scenario, {"oracle", "oracle", "oracle", "yoon2021"});
  expect_sum(budget.physical_ms);
  EXPECT_NEAR(stage_mean(budget.physical_ms, BudgetStage::kTrigger), budget.physical_ms.total.mean,
              0.01);
  EXPECT_NEAR(stage_mean(budget.amd_ms, BudgetStage::kTrigger), budget.amd_ms.total.mean, 0.01);
  EXPECT_NEAR(stage_mean(budget.amd_ms, BudgetStage::kUsbDelivery), 0, 1e-9);
  EXPECT_NEAR(stage_mean(budget.absolute_error_ms, BudgetStage::kTrigger), 0, 1e-6);
}

}  // namespace
}  // namespace simbench::evaluation
