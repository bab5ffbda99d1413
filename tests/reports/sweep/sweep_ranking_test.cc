#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "reports/sweep/sweep_report.h"
#include "reports/text/plain_text.h"

namespace simbench::reports {
namespace {

using evaluation::SweepPlan;
using evaluation::SweepScore;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// Sweeps the hosts' clocks alone; three poll intervals, 16 seeds.
SweepPlan plan_of_clocks() {
  SweepPlan plan;
  plan.scenario = "star";
  plan.axes = {evaluation::parse_axis("/algorithms/chrony/min_poll=-2,2,6")};
  plan.pipelines = {"chrony", "ntp"};
  plan.seeds = 16;
  plan.kind = evaluation::ResultKind::kClockRuns;
  return plan;
}

// chrony's error falls with its packets; ntp asks as ever and is between.
std::vector<evaluation::ResponseRow> rows_of_clocks(const SweepPlan& plan) {
  std::vector<SweepScore> scores;
  for (std::size_t i = 0; i < plan.runs(); ++i) {
    const evaluation::SweepRun run = plan.run(i);
    const double noise = std::exp(0.1 * std::sin(7.0 * static_cast<double>(run.seed)));
    SweepScore score(plan.kind);
    const bool is_chrony = run.pipeline == 0;
    const double asks[] = {8, 0.5, 0.03};
    score.at("packets_per_s") = is_chrony ? asks[run.point] : 0.0625;
    score.at("clock_spread_ms") = noise * (is_chrony ? 1e-3 / asks[run.point] : 0.01);
    scores.push_back(score);
  }
  return evaluation::response(plan, scores);
}

TEST(SweepRanking, SaysTheOrderAndWhereItFlips) {
  const SweepPlan plan = plan_of_clocks();
  const std::string text = plain({.blocks = {ranking_block(plan, rows_of_clocks(plan))}});
  EXPECT_THAT(text, HasSubstr("The order by spread of the clocks"));
  EXPECT_THAT(text, HasSubstr("-2  chrony < ntp"));
  EXPECT_THAT(text, HasSubstr("6  ntp < chrony"));
  EXPECT_THAT(text,
              HasSubstr("chrony is better than ntp up to /algorithms/chrony/min_poll=2, worse "
                        "from"));
}

TEST(SweepRanking, SaysThatNothingFlips) {
  SweepPlan plan = plan_of_clocks();
  plan.axes = {evaluation::parse_axis("/algorithms/chrony/min_poll=-2,2")};
  const std::string text = plain({.blocks = {ranking_block(plan, rows_of_clocks(plan))}});
  EXPECT_THAT(text, AllOf(HasSubstr("No two pipelines change places within these values."),
                          Not(HasSubstr("worse from"))));
}

TEST(SweepPackets, ListsWhatEachPipelineReachesForItsPackets) {
  const SweepPlan plan = plan_of_clocks();
  const std::string text = plain({.blocks = {packets_block(plan, rows_of_clocks(plan))}});
  EXPECT_THAT(text, HasSubstr("Spread of the clocks over packets per second"));
  const std::size_t few = text.find("0.0300");
  const std::size_t many = text.find("8.00");
  EXPECT_NE(few, std::string::npos);
  EXPECT_LT(few, many) << "in order of the packets";
  EXPECT_EQ(text.find("0.0625"), text.rfind("0.0625")) << "what does not change is listed once";
}

TEST(SweepPackets, TheFigureHasPacketsOnX) {
  const SweepPlan plan = plan_of_clocks();
  const Figure figure = packets_figure(plan, rows_of_clocks(plan));
  ASSERT_EQ(figure.panels.size(), 1u);
  const FigurePanel& panel = figure.panels.front();
  EXPECT_TRUE(panel.log_x);
  ASSERT_EQ(panel.series.size(), 2u);
  EXPECT_THAT(panel.series[0].x, ElementsAre(0.03, 0.5, 8));
  EXPECT_THAT(panel.series[1].x, ElementsAre(0.0625));
}

}  // namespace
}  // namespace simbench::reports
