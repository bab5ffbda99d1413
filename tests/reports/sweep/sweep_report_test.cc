#include "reports/sweep/sweep_report.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace simbench::reports {
namespace {

using evaluation::ResponseRow;
using evaluation::SweepPlan;
using evaluation::SweepScore;
using testing::ElementsAre;
using testing::HasSubstr;

// Two hosts counts, two words; two pipelines; two seeds.
SweepPlan plan() {
  SweepPlan plan;
  plan.scenario = "rig";
  plan.scenario_json = R"({"name": "rig"})";
  plan.axes = {evaluation::parse_axis("/hosts/count=4,2+/cameras/count=8,4"),
               evaluation::parse_axis("/network/stamp_point=kernel,application")};
  plan.pipelines = {"fast", "slow"};
  plan.first_seed = 7;
  plan.seeds = 2;
  return plan;
}

// AMD counts the runs: 0, 1, 2, ...; recall is 3/4 in all; the slaves are late by 1, 2, ... ms.
std::vector<SweepScore> scores() {
  std::vector<SweepScore> scores;
  for (std::size_t run = 0; run < plan().runs(); ++run) {
    SweepScore score;
    score.at("amd_ms") = static_cast<double>(run);
    score.at("absolute_error_ms") = std::numeric_limits<double>::quiet_NaN();
    score.at("sets") = 3;
    score.at("pure_sets") = 3;
    score.at("complete_pulses") = 4;
    score.host_errors_ms = {0, 1, -2};
    scores.push_back(score);
  }
  return scores;
}

std::vector<ResponseRow> rows() { return evaluation::response(plan(), scores()); }

TEST(SweepReport, TheManifestSaysWhatIsSwept) {
  const auto manifest = nlohmann::json::parse(sweep_manifest(plan(), "a_study"));
  EXPECT_EQ(manifest["kind"], "sweep");
  EXPECT_EQ(manifest["study"], "a_study");
  EXPECT_EQ(manifest["axes"][0]["/hosts/count"], nlohmann::json({4, 2}));
  EXPECT_EQ(manifest["axes"][1]["/network/stamp_point"], nlohmann::json({"kernel", "application"}));
  EXPECT_EQ(manifest["seeds"]["first"], 7);
  EXPECT_EQ(manifest["scenario"]["name"], "rig");
  EXPECT_FALSE(nlohmann::json::parse(sweep_manifest(plan(), "")).contains("study"));
}

TEST(SweepReport, CsvHasALineForEachRun) {
  const std::string csv = sweep_csv(plan(), scores());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 17);
  EXPECT_THAT(csv, testing::StartsWith("/hosts/count,/cameras/count,/network/stamp_point,pipeline,"
                                       "seed,amd_ms,rmdv_ms,absolute_error_ms,bias_ms,"));
  EXPECT_THAT(csv, HasSubstr("\n4,8,kernel,fast,7,0,0,,0,"));
  EXPECT_THAT(csv, HasSubstr("\n2,4,application,slow,8,15,0,,0,"));
}

TEST(SweepReport, HostsCsvHasALineForEachHostOfEachRun) {
  const std::string csv = sweep_hosts_csv(plan(), scores());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 16 * 3);
  EXPECT_THAT(csv, HasSubstr("\n4,8,kernel,fast,7,2,-2\n"));
}

TEST(SweepReport, TheResponseIsOfAllSeeds) {
  const std::vector<ResponseRow> all = rows();
  ASSERT_EQ(all.size(), 8U);
  EXPECT_EQ(all[0].of("amd_ms").median, 0.5);
  EXPECT_EQ(all[7].of("amd_ms").median, 14.5);
  EXPECT_EQ(all[3].pooled.recall, 0.75);
  EXPECT_EQ(all[3].pooled.precision, 1);
  EXPECT_EQ(all[3].value(evaluation::metric("recall")), 0.75);
  EXPECT_EQ(all[7].value(evaluation::metric("amd_ms")), 14.5);
  EXPECT_EQ(all[3].hosts[2].median, 2);
  const std::string table = plain({.blocks = {response_block(plan(), all)}});
  EXPECT_THAT(table, HasSubstr("4 points, 2 pipelines, 2 seeds"));
  EXPECT_THAT(table, testing::ContainsRegex("2 +4 +application +slow +14.5 ms "));
  EXPECT_THAT(table, HasSubstr("75.0 %"));
}

TEST(SweepReport, SaysOverHowManySeedsAMedianIs) {
  std::vector<SweepScore> some = scores();
  EXPECT_THAT(plain({.blocks = {response_block(plan(), rows())}}), testing::Not(HasSubstr("of 2")));
  some[0].at("amd_ms") = std::numeric_limits<double>::quiet_NaN();
  some[0].at("packets_per_s") = std::numeric_limits<double>::quiet_NaN();
  some[0].at("host_error_ms") = std::numeric_limits<double>::quiet_NaN();
  const std::string table =
      plain({.blocks = {response_block(plan(), evaluation::response(plan(), some))}});
  EXPECT_THAT(table, testing::ContainsRegex("4 +8 +kernel +fast +1 of 2 +1.00 ms "));
  EXPECT_THAT(table, testing::ContainsRegex("2 +4 +application +slow +2 of 2 +14.5 ms "));
  EXPECT_THAT(table, HasSubstr("medians and bands are over them"));
}

TEST(SweepReport, HostsInTheOrderOfTheirSessions) {
  EXPECT_THAT(plain({.blocks = {host_order_block(plan(), rows())}}),
              testing::ContainsRegex("4 +8 +kernel +fast +1.00 ms  2.00 ms\n"));
}

TEST(SweepReport, SeedsNeededUpToThoseThatWereRun) {
  SweepPlan one = plan();
  one.axes = {};
  one.pipelines = {"fast"};
  one.seeds = 40;
  std::vector<SweepScore> many(40);
  for (std::size_t i = 0; i < many.size(); ++i)
    many[i].at("amd_ms") = 1 + static_cast<double>(i) / 39;
  const std::string table =
      plain({.blocks = {seeds_needed_block(one, evaluation::response(one, many))}});
  EXPECT_THAT(table, HasSubstr("n = 32"));
  EXPECT_THAT(table, testing::Not(HasSubstr("n = 64")));
  EXPECT_THAT(table, HasSubstr("+-5 %"));
}

TEST(SweepFigure, ACurveForEachPipelineAndOtherStep) {
  const Figure figure = response_figure(plan(), rows());
  ASSERT_EQ(figure.panels.size(), 4U);
  std::vector<std::string> axes;
  for (const FigurePanel& panel : figure.panels) axes.push_back(panel.y_label);
  EXPECT_THAT(axes, ElementsAre("median AMD [5-95 %], ms", "median absolute error [5-95 %], ms",
                                "recall, %", "median margin [5-95 %], ms"));
  const FigurePanel& amd = figure.panels[0];
  EXPECT_EQ(amd.x_label, "/hosts/count");
  ASSERT_EQ(amd.series.size(), 4U);
  EXPECT_EQ(amd.series[0].label, "fast, stamp_point=kernel");
  EXPECT_THAT(amd.series[0].x, ElementsAre(2, 4));  // ascending, though swept downwards
  EXPECT_THAT(amd.series[0].y, ElementsAre(8.5, 0.5));
  EXPECT_EQ(amd.series[3].label, "slow, stamp_point=application");
  EXPECT_THAT(amd.series[3].y, ElementsAre(14.5, 6.5));
  EXPECT_THAT(figure.panels[2].series[1].y, ElementsAre(75, 75));
  EXPECT_EQ(amd.series[0].mark, Mark::kMarkedLine);
  EXPECT_THAT(amd.series[0].low, ElementsAre(8.05, 0.05));  // 8, 9 and 0, 1
  EXPECT_THAT(amd.series[0].high, ElementsAre(8.95, 0.95));
  EXPECT_TRUE(figure.panels[2].series[1].low.empty());
}

TEST(SweepFigure, WordsAreCategories) {
  SweepPlan words = plan();
  std::swap(words.axes[0], words.axes[1]);
  const FigurePanel panel =
      response_figure(words, evaluation::response(words, scores())).panels.front();
  EXPECT_THAT(panel.categories, ElementsAre("kernel", "application"));
  ASSERT_EQ(panel.series.size(), 4U);
  std::set<double> places;
  for (const FigureSeries& series : panel.series) {
    EXPECT_EQ(series.mark, Mark::kPoints);
    EXPECT_EQ(series.low.size(), 2U);
    ASSERT_EQ(series.x.size(), 2U);
    EXPECT_EQ(std::llround(series.x[0]), 0);
    EXPECT_EQ(std::llround(series.x[1]), 1);
    places.insert(series.x[0]);
  }
  EXPECT_EQ(places.size(), 4U);  // none over another
  EXPECT_NEAR(*places.begin() + *places.rbegin(), 0, 1e-12);
}

TEST(SweepFigure, OnePointIsNoResponse) {
  SweepPlan one = plan();
  one.axes = {};
  const Figure figure =
      response_figure(one, evaluation::response(one, std::vector<SweepScore>(one.runs())));
  EXPECT_TRUE(figure.panels.empty());
  EXPECT_FALSE(figure.absent.empty());
}

TEST(SweepFigure, HostsAndSeeds) {
  const Figure hosts = host_order_figure(plan(), rows());
  EXPECT_THAT(hosts.panels[0].series[0].x, ElementsAre(1, 2));
  EXPECT_THAT(hosts.panels[0].series[0].y, ElementsAre(1, 2));
  SweepPlan one = plan();
  one.axes = {};
  one.seeds = 16;
  const std::vector<SweepScore> equal(one.runs(), scores()[3]);
  const FigureSeries series =
      seeds_needed_figure(one, evaluation::response(one, equal)).panels[0].series[0];
  EXPECT_EQ(series.x.front(), 8);
  EXPECT_EQ(series.x.back(), 16);
  EXPECT_EQ(series.y.back(), 0);
}

SweepPlan clock_plan() {
  SweepPlan clocks = plan();
  clocks.axes = {evaluation::parse_axis("/hosts/count=4,2")};
  clocks.kind = evaluation::ResultKind::kClockRuns;
  clocks.clock_period = {.from_s = 300, .duration_s = 7200};
  return clocks;
}

// Spreads of nanoseconds, times 10 from run to run.
std::vector<SweepScore> clock_scores() {
  std::vector<SweepScore> scores;
  double spread_ms = 1.25e-6;
  for (std::size_t run = 0; run < clock_plan().runs(); ++run, spread_ms *= 10) {
    SweepScore score(evaluation::ResultKind::kClockRuns);
    score.at("clock_spread_ms") = spread_ms;
    score.at("max_te_ms") = 2 * spread_ms;
    score.at("holdover_600_ms") = 3;
    score.at("below_0_01_ms_s") = std::numeric_limits<double>::quiet_NaN();
    score.host_errors_ms = {0, spread_ms};
    scores.push_back(score);
  }
  return scores;
}

TEST(ClockSweep, TheManifestSaysWhichClockRuns) {
  const auto manifest = nlohmann::json::parse(sweep_manifest(clock_plan(), ""));
  EXPECT_EQ(manifest["results"], "clocks");
  EXPECT_EQ(manifest["from_s"], 300);
  EXPECT_EQ(manifest["duration_s"], 7200);
  EXPECT_FALSE(nlohmann::json::parse(sweep_manifest(plan(), "")).contains("results"));
}

TEST(ClockSweep, CsvHasTheMetricsOfClocks) {
  const std::string csv = sweep_csv(clock_plan(), clock_scores());
  EXPECT_THAT(csv, testing::StartsWith("/hosts/count,pipeline,seed,clock_spread_ms,"));
  EXPECT_THAT(csv, testing::Not(HasSubstr("amd_ms")));
  EXPECT_THAT(csv, HasSubstr("\n4,fast,7,1.25e-06,"));
  EXPECT_THAT(sweep_hosts_csv(clock_plan(), clock_scores()), HasSubstr("\n4,fast,7,1,1.25e-06\n"));
}

TEST(ClockSweep, TheTableShowsNanoseconds) {
  const std::vector<ResponseRow> all = evaluation::response(clock_plan(), clock_scores());
  const std::string table = plain({.blocks = {response_block(clock_plan(), all)}});
  EXPECT_THAT(table, HasSubstr("2 seeds, the hosts' clocks alone"));
  EXPECT_THAT(table, testing::ContainsRegex("4 +fast +6.88 ns +.1.81, 11.9. ns "));
  EXPECT_THAT(table, HasSubstr("measured from 300 to 7200 s"));
  EXPECT_THAT(table, testing::Not(HasSubstr("precision")));
  EXPECT_THAT(table, testing::Not(HasSubstr("single one")));
}

TEST(ClockSweep, TheFigureIsLogarithmicWhereWide) {
  const Figure figure =
      response_figure(clock_plan(), evaluation::response(clock_plan(), clock_scores()));
  ASSERT_EQ(figure.panels.size(), 3U);
  EXPECT_EQ(figure.panels[0].title, "Spread of the clocks");
  EXPECT_EQ(figure.panels[0].y_label, "median [5-95 %], ms");
  EXPECT_TRUE(figure.panels[0].log_y);
  EXPECT_TRUE(figure.panels[1].log_y);
  EXPECT_FALSE(figure.panels[2].log_y);
  ASSERT_EQ(figure.panels[1].series.size(), 2U);
  EXPECT_NEAR(figure.panels[1].series[0].y[1], 1.375e-5, 1e-12);
}

}  // namespace
}  // namespace simbench::reports
