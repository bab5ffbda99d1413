#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "reports/page/sweep_page.h"
#include "reports/sweep/sweep_report.h"
#include "scenarios/loader.h"
#include "tests/reports/whole_text.h"

namespace simbench::reports {
namespace {

using evaluation::SweepPlan;
using evaluation::SweepScore;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

SweepPlan star_plan(const std::string& axis) {
  SweepPlan plan;
  plan.scenario = "6host_star";
  plan.scenario_json = scenarios::load_scenario("6host_star").resolved_json();
  plan.axes = {evaluation::parse_axis(axis)};
  plan.pipelines = {"chrony", "oracle", "ntp"};
  plan.seeds = 16;
  plan.kind = evaluation::ResultKind::kClockRuns;
  return plan;
}

// chrony has 0.001, 0.01 and 0.1 ms at the points, ntp 0.02, the oracle always less.
std::vector<evaluation::ResponseRow> star_rows(const SweepPlan& plan) {
  std::vector<SweepScore> scores;
  for (std::size_t i = 0; i < plan.runs(); ++i) {
    const evaluation::SweepRun run = plan.run(i);
    const double noise = std::exp(0.1 * std::sin(7.0 * static_cast<double>(run.seed)));
    const double of_chrony[] = {1e-3, 1e-2, 1e-1};
    const double of_each[] = {of_chrony[run.point], 1e-9, 2e-2};
    SweepScore score(plan.kind);
    score.at("clock_spread_ms") = noise * of_each[run.pipeline];
    scores.push_back(score);
  }
  return evaluation::response(plan, scores);
}

std::string sweep_text(const SweepPlan& plan) {
  return whole_text(sweep_answer(plan, star_rows(plan)));
}

TEST(SweepAnswer, LeavesOutWhatNoRigCanRun) {
  const std::string text = sweep_text(star_plan("/network/latency_fixed_ms=0.1,0.2,0.3"));
  EXPECT_THAT(text, StartsWith("chrony is the best of the 2 pipelines that a rig can run at 2 of 3 "
                               "points (beyond chance at 2): spread of the clocks 1.0"));
  EXPECT_THAT(text, Not(HasSubstr("oracle")));
}

TEST(SweepAnswer, SaysWherePipelinesChangePlacesAndWhatMatters) {
  const std::string text = sweep_text(star_plan("/network/latency_fixed_ms=0.1,0.2,0.3"));
  EXPECT_THAT(text, HasSubstr("chrony is better than ntp up to /network/latency_fixed_ms=0.2, "
                              "worse from /network/latency_fixed_ms=0.3 on."));
  EXPECT_THAT(text, HasSubstr("It is best at /network/latency_fixed_ms=0.1 and worst at "
                              "/network/latency_fixed_ms=0.3."));
  EXPECT_THAT(text, HasSubstr("/network/latency_fixed_ms matters to it: between its values the "
                              "spread of the clocks changes up to 100 times."));
}

TEST(SweepAnswer, SaysSoWhereOnlyAnOracleRan) {
  SweepPlan plan = star_plan("/network/latency_fixed_ms=0.1,0.2");
  plan.pipelines = {"oracle"};
  EXPECT_THAT(sweep_text(plan), HasSubstr("No pipeline here is one that a rig can run."));
}

TEST(SweepPage, BeginsWithTheAnswerAndSaysHowToRepeatIt) {
  const SweepPlan plan = star_plan("/network/latency_fixed_ms=0.1,0.2");
  Figure figure;
  figure.id = "sweep";
  figure.absent = "none";
  const std::string page = sweep_html({.plan = plan,
                                       .answer = {.lead = "The answer."},
                                       .figures = {figure},
                                       .blocks = {{.heading = "The table"}}});
  EXPECT_LT(page.find("The answer."), page.find("data-figures=\"sweep\""));
  EXPECT_LT(page.find("data-figures=\"sweep\""), page.find("The table"));
  EXPECT_NE(page.find("simbench sweep --scenario FILE --sweep /network/latency_fixed_ms=0.1,0.2 "
                      "--clocks"),
            std::string::npos);
}

}  // namespace
}  // namespace simbench::reports
