#include "reports/results/budget_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace simbench::reports {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

evaluation::BudgetPart part(double mean) {
  return {.values = {mean}, .mean = mean, .p05 = mean, .p95 = mean};
}

// Every stage adds its number; an eighth remains.
evaluation::ErrorParts parts() {
  evaluation::ErrorParts error;
  for (std::size_t stage = 0; stage < evaluation::kStageCount; ++stage) {
    error.stages[stage] = part(static_cast<double>(stage));
  }
  error.remainder = part(0.125);
  error.total = part(21.125);
  return error;
}

evaluation::HostClockBudget host_clock_sample() {
  return {.pipeline = "mine",
          .note = "",
          .is_divided = true,
          .total = part(8),
          .parts = {part(4), part(2), part(-1)},
          .algorithm = part(3)};
}

BudgetReport sample_report() {
  evaluation::Budget budget;
  budget.pipeline = "mine";
  budget.amd_ms = parts();
  budget.absolute_error_ms = parts();
  budget.physical_ms = parts();
  return {.scenario = "sample",
          .first_seed = 1,
          .seeds = 1,
          .budgets = {{budget, host_clock_sample()}}};
}

TEST(BudgetReport, ASteeredPipelineHasAPhaseAndAGranularity) {
  BudgetReport report = sample_report();
  EXPECT_THAT(plain(budget_document(report)), Not(HasSubstr("granularity")));
  report.budgets.front().stages.is_steered = true;
  const std::string text = plain(budget_document(report));
  EXPECT_THAT(text, HasSubstr("phase"));
  EXPECT_THAT(text, HasSubstr("granularity"));
  EXPECT_THAT(text, Not(HasSubstr("trigger")));
}

TEST(BudgetReport, ALineForEveryStageItsShareAndTheTotal) {
  const std::string text = plain(budget_document(sample_report()));
  EXPECT_THAT(text, HasSubstr("Error budget of mine in sample, 1 seed (1)"));
  EXPECT_THAT(text, HasSubstr("USB delivery"));
  EXPECT_THAT(text, HasSubstr("28.4 %"));  // of the gathering: 6 / 21.125
  EXPECT_THAT(text, HasSubstr("over the sets that gathering emits"));
  EXPECT_THAT(markdown(budget_document(sample_report())), HasSubstr("## Error budget of mine"));
}

TEST(BudgetReport, SaysWhenGatheringHasNoPart) {
  BudgetReport report = sample_report();
  report.budgets[0].stages.amd_of_sets = false;
  EXPECT_THAT(plain(budget_document(report)), HasSubstr("gathering has no part"));
}

TEST(BudgetReport, DividesTheHostClockErrorBetweenWorldAndAlgorithm) {
  const std::string text = plain(budget_document(sample_report()));
  EXPECT_THAT(text, HasSubstr("Host clock error of mine in sample, 1 seed (1)"));
  EXPECT_THAT(text, ContainsRegex("estimation +messages +4.00 ms +.4.00, 4.00. ms +50.0 %"));
  EXPECT_THAT(text, ContainsRegex("steering +clock calls +-1.00 ms"));
  EXPECT_THAT(text, ContainsRegex("algorithm +- +3.00 ms .*37.5 %"));
  const auto root = nlohmann::json::parse(budget_json(sample_report()));
  const auto& error = root["budgets"][0]["host_error_ms"];
  EXPECT_TRUE(error["note"].is_null());
  EXPECT_EQ(error["parts"][1]["part"], "staleness");
  EXPECT_EQ(error["parts"][1]["cause"], "oscillators");
  EXPECT_EQ(error["parts"][1]["mean"], 2);
  EXPECT_EQ(error["algorithm"]["mean"], 3);
  EXPECT_EQ(error["total"]["values"][0], 8);
}

TEST(BudgetReport, HasANoteAndNoNumberWhereTheHostClockIsNotDivided) {
  BudgetReport report = sample_report();
  report.budgets[0].host_clock = {.pipeline = "mine", .note = "there is one host"};
  const std::string text = plain(budget_document(report));
  EXPECT_THAT(text, HasSubstr("Not divided: there is one host."));
  EXPECT_THAT(text, Not(HasSubstr("estimation")));
  const auto root = nlohmann::json::parse(budget_json(report));
  const auto& error = root["budgets"][0]["host_error_ms"];
  EXPECT_EQ(error["note"], "there is one host");
  EXPECT_EQ(error.size(), 1U);
}

TEST(BudgetReport, JsonHasEveryStageAndNullForWhatDoesNotExist) {
  BudgetReport report = sample_report();
  report.budgets[0].stages.physical_ms.total = part(std::numeric_limits<double>::quiet_NaN());
  const auto root = nlohmann::json::parse(budget_json(report));
  const auto& budget = root["budgets"][0];
  EXPECT_EQ(budget["amd_ms"]["stages"][6]["stage"], "gathering");
  EXPECT_DOUBLE_EQ(budget["amd_ms"]["stages"][6]["mean"].get<double>(), 6);
  EXPECT_TRUE(budget["physical_ms"]["total"]["mean"].is_null());
}

}  // namespace
}  // namespace simbench::reports
