#include "reports/results/results_answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/results/summary_document.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using evaluation::RankedBy;
using testing::HasSubstr;
using testing::Not;

std::string answer_text(const evaluation::Results& results,
                        const evaluation::Budget* budget = nullptr) {
  return paragraphs(results_answer(results, RankedBy::kAmd, budget)).front();
}

evaluation::BudgetPart equal_part(double mean) {
  return {.values = {mean, mean}, .mean = mean, .p05 = mean, .p95 = mean};
}

evaluation::Budget budget_of(double host_clock_ms, double delivery_ms) {
  evaluation::Budget budget;
  for (evaluation::BudgetPart& stage : budget.amd_ms.stages) stage = equal_part(0);
  for (evaluation::BudgetPart& stage : budget.amd_ms.alone) stage = equal_part(0);
  budget.amd_ms.stages[static_cast<std::size_t>(evaluation::BudgetStage::kHostClock)] =
      equal_part(host_clock_ms);
  budget.amd_ms.stages[static_cast<std::size_t>(evaluation::BudgetStage::kUsbDelivery)] =
      equal_part(delivery_ms);
  budget.amd_ms.alone[static_cast<std::size_t>(evaluation::BudgetStage::kHostClock)] =
      equal_part(host_clock_ms / 2);
  budget.amd_ms.total = equal_part(host_clock_ms + delivery_ms);
  return budget;
}

TEST(ResultsAnswer, NamesTheBestWithItsBand) {
  const std::string text = answer_text(sample_results());
  EXPECT_THAT(text, HasSubstr("yoon2021_both is the best of the 2 pipelines that a rig can run: "
                              "AMD 2.00 ms (5-95 %: [1.50, 2.50] ms)."));
}

TEST(ResultsAnswer, DoubtsSetsThatLackPulses) {
  EXPECT_THAT(answer_text(sample_results()),
              HasSubstr("Do not trust its sets: 0 % of them mix pulses, 25.0 % of the pulses are "
                        "not whole."));
}

TEST(ResultsAnswer, TrustsSetsWithoutAFault) {
  evaluation::Results results = sample_results();
  results.rows.front().recall = 1;
  EXPECT_THAT(answer_text(results), HasSubstr("none of 720 mixes pulses, no pulse is missing, with "
                                              "8.50 ms to spare."));
}

TEST(ResultsAnswer, SaysWhatLimitsItAndWhatWouldBeWon) {
  const evaluation::Budget budget = budget_of(3, 1);
  EXPECT_THAT(answer_text(sample_results(), &budget),
              HasSubstr("What limits it (error budget over 2 seeds): host clock 75 %, USB delivery "
                        "25 %. Most would be won by perfect host clocks: 38 % of it."));
  EXPECT_THAT(answer_text(sample_results()), Not(HasSubstr("What limits it")));
}

TEST(ResultsAnswer, SaysThatAmdHidesWhatAllCamerasShare) {
  EXPECT_THAT(answer_text(sample_results()),
              HasSubstr("AMD hides that all cameras are 29.0 ms off together"));
}

TEST(ResultsAnswer, SaysSoWhereThereIsNoAnswer) {
  EXPECT_EQ(answer_text({}), "No pipeline that a rig can run has a result here.");
}

TEST(Summary, HasTheAnswerATableAndWhatFailed) {
  const AnswerText answer = results_answer(sample_results(), RankedBy::kAmd, nullptr);
  const std::string text = plain(summary_document(sample_results(), {.summary = "A fit."}, answer));
  EXPECT_THAT(text, HasSubstr("sample: 2 seeds (1-2)\nyoon2021_both is the best"));
  EXPECT_THAT(text, HasSubstr("2.00 ms"));
  EXPECT_THAT(text, HasSubstr("host synchronisation failed once"));
  EXPECT_THAT(text, Not(HasSubstr("RMDV")));
  const std::string quiet = plain(quiet_document(sample_results(), answer));
  EXPECT_THAT(quiet, Not(HasSubstr("pipeline  ")));
  EXPECT_THAT(quiet, HasSubstr("host synchronisation failed once"));
}

}  // namespace
}  // namespace simbench::reports
