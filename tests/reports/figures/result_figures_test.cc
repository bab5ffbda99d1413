#include "reports/figures/result_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "evaluation/statistics/statistics.h"

namespace simbench::reports {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

evaluation::Row row(const std::string& pipeline, const std::vector<double>& amd_ms) {
  evaluation::Row made;
  made.pipeline = pipeline;
  made.amd_ms = evaluation::make_series(amd_ms);
  for (std::size_t i = 0; i < amd_ms.size(); ++i) {
    evaluation::SeedScore seed;
    seed.seed = 1 + i;
    seed.pulses = {{.pulse = 10, .spread_ms = amd_ms[i] - 1, .deviation_ms = 1},
                   {.pulse = 11, .spread_ms = amd_ms[i] + 1, .deviation_ms = 2}};
    seed.host_errors_ms = {0, -amd_ms[i], 2 * amd_ms[i]};
    made.seeds.push_back(seed);
  }
  return made;
}

Archive archive_of(std::vector<evaluation::Row> rows) {
  Archive made;
  made.path = "results";
  made.results.first_seed = 1;
  made.results.seed_count = rows.front().seeds.size();
  made.results.rows = std::move(rows);
  return made;
}

TEST(ResultFiguresTest, FrameErrorsAreTheTermsOfOneSeed) {
  const Archive results = archive_of({row("mine", {2, 4}), row("yours", {3, 5})});
  const std::vector<Figure> figures = frame_errors(results);
  ASSERT_THAT(figures, SizeIs(2));
  EXPECT_EQ(figures[1].seed, 2U);
  ASSERT_THAT(figures[1].panels, SizeIs(2));
  ASSERT_THAT(figures[1].panels[0].series, SizeIs(2));
  EXPECT_THAT(figures[1].panels[0].series[0].x, ElementsAre(10, 11));
  EXPECT_THAT(figures[1].panels[0].series[0].y, ElementsAre(3, 5));
  EXPECT_THAT(figures[1].panels[1].series[1].y, ElementsAre(1, 2));
}

TEST(ResultFiguresTest, ThePapersRowsAreTakenWhereTheyAre) {
  const Archive results = archive_of({row("mine", {2}), row("yoon2021_both", {3}),
                                      row("ntp_last_set", {500}), row("yoon2021_time", {4})});
  const Figure figure = frame_errors(results, 1);
  ASSERT_THAT(figure.panels[0].series, SizeIs(3));
  EXPECT_EQ(figure.panels[0].series[0].label, "ntp_last_set");
  EXPECT_EQ(figure.panels[0].series[2].label, "yoon2021_both");
  EXPECT_TRUE(figure.panels[0].log_y);
}

TEST(ResultFiguresTest, AnUnknownSeedHasNoFrameErrors) {
  EXPECT_FALSE(frame_errors(archive_of({row("mine", {2})}), 9).absent.empty());
}

TEST(ResultFiguresTest, ADistributionIsTheSortedValuesWithThePublishedOne) {
  Archive results = archive_of({row("mine", {3, 1, 2})});
  results.results.rows[0].published.emplace().amd_ms = 2.5;
  const std::vector<Figure> figures = distributions(results);
  ASSERT_THAT(figures, SizeIs(2));
  EXPECT_EQ(figures[0].pipeline, "");
  EXPECT_EQ(figures[1].pipeline, "mine");
  const FigurePanel& amd = figures[1].panels.at(0);
  EXPECT_EQ(amd.series.at(0).mark, Mark::kLine);
  EXPECT_THAT(amd.series.at(0).y, ElementsAre(1, 2, 3));
  EXPECT_THAT(amd.series.at(0).x, ElementsAre(0, 50, 100));
  ASSERT_THAT(amd.lines, SizeIs(1));
  EXPECT_EQ(amd.lines[0].at, 2.5);
}

// The curve at x, between its points.
double curve_at(const FigureSeries& curve, double x) {
  std::size_t i = 1;
  while (curve.x.at(i) < x) ++i;
  const double share = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
  return curve.y[i - 1] + share * (curve.y[i] - curve.y[i - 1]);
}

TEST(ResultFiguresTest, ADistributionHasTheMedianAndTheBandOfTheTables) {
  for (const std::vector<double>& values :
       std::vector<std::vector<double>>{{7}, {1, 2}, {8, 1, 2, 4}, {5, 1, 9, 2, 2, 7}}) {
    const evaluation::Row mine = row("mine", values);
    const std::vector<Figure> figures = distributions(archive_of({mine}));
    const FigureSeries& curve = figures.at(0).panels.at(0).series.at(0);
    EXPECT_DOUBLE_EQ(curve_at(curve, 50), mine.amd_ms.median);
    EXPECT_NEAR(curve_at(curve, 5), mine.amd_ms.p05, 1e-12);
    EXPECT_NEAR(curve_at(curve, 95), mine.amd_ms.p95, 1e-12);
  }
}

TEST(ResultFiguresTest, ADistributionOfFewerSeedsSaysSo) {
  const Archive whole = archive_of({row("mine", {1, 2})});
  EXPECT_THAT(distributions(whole)[0].caption, testing::Not(HasSubstr("Not every seed")));
  const Archive some = archive_of({row("mine", {1, evaluation::kNan})});
  EXPECT_THAT(distributions(some)[0].caption, HasSubstr("Not every seed"));
}

TEST(ResultFiguresTest, APublishedLineHasTheColourOfItsPipeline) {
  Archive results = archive_of({row("mine", {2, 4}), row("yours", {3, 5})});
  results.results.rows[0].published.emplace().amd_ms = 2.5;
  results.results.rows[1].published.emplace().amd_ms = 3.5;
  const std::vector<Figure> figures = distributions(results);
  const FigurePanel& together = figures.at(0).panels.at(0);
  ASSERT_THAT(together.lines, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(together.lines[i].colour, together.series.at(i).colour);
  }
  EXPECT_NE(together.lines[0].colour, together.lines[1].colour);
}

TEST(ResultFiguresTest, HostOrderIsTheMedianByHost) {
  const std::vector<Figure> figures = host_order(archive_of({row("mine", {3, 1, 2})}));
  const FigureSeries& medians = figures.at(0).panels.at(0).series.at(0);
  EXPECT_THAT(medians.x, ElementsAre(1, 2));
  EXPECT_THAT(medians.y, ElementsAre(2, 4));
  const FigureSeries& seeds = figures.at(1).panels.at(1).series.at(0);
  EXPECT_THAT(seeds.x, SizeIs(6));
  EXPECT_EQ(seeds.y[0], -3);
}

TEST(ResultFiguresTest, OfManyPipelinesTheFirstAreDrawnTogether) {
  std::vector<evaluation::Row> rows;
  rows.reserve(40);
  for (int i = 0; i < 40; ++i) rows.push_back(row("pipeline " + std::to_string(i), {1.0 + i}));
  const std::vector<Figure> figures = distributions(archive_of(std::move(rows)));
  EXPECT_THAT(figures, SizeIs(41));
  EXPECT_THAT(figures[0].panels[0].series, SizeIs(12));
  EXPECT_THAT(figures[0].caption, HasSubstr("first 12 of 40"));
}

TEST(BudgetFigureTest, ABarForEveryStageAndTheRemainder) {
  evaluation::Budget budget;
  budget.pipeline = "mine";
  budget.amd_ms.total = {.values = {3}, .mean = 3, .p05 = 3, .p95 = 3};
  budget.amd_ms.stages[5] = {.values = {2}, .mean = 2, .p05 = 1, .p95 = 4};
  budget.amd_ms.remainder = {.values = {1}, .mean = 1, .p05 = 1, .p95 = 1};
  evaluation::HostClockBudget host_clock = {.pipeline = "mine", .is_divided = true};
  host_clock.parts[0] = {.values = {5}, .mean = 5, .p05 = 5, .p95 = 5};
  host_clock.algorithm = {.values = {2}, .mean = 2, .p05 = 2, .p95 = 2};
  const Figure figure = budget_figure({budget, host_clock});
  EXPECT_EQ(figure.pipeline, "mine");
  const FigurePanel& amd = figure.panels.at(0);
  ASSERT_THAT(amd.categories, SizeIs(evaluation::budget_stages(budget).size() + 1));
  EXPECT_EQ(amd.categories[5], "host clock");
  EXPECT_THAT(amd.series.at(0).y, ElementsAre(0, 0, 0, 0, 0, 2, 0, 1));
  EXPECT_EQ(amd.series.at(2).y.at(5), 4);
  const FigurePanel& hosts = figure.panels.back();
  EXPECT_THAT(hosts.categories, ElementsAre("estimation", "staleness", "steering", "algorithm"));
  EXPECT_THAT(hosts.series.at(0).y, ElementsAre(5, 0, 0, 2));
}

TEST(BudgetFigureTest, SaysWhyHostClocksAreNotDivided) {
  const Figure figure = budget_figure({{}, {.pipeline = "mine", .note = "one host"}});
  EXPECT_THAT(figure.panels, SizeIs(3));
  EXPECT_THAT(figure.caption, HasSubstr("not divided: one host"));
}

}  // namespace
}  // namespace simbench::reports
