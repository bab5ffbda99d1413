
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "reports/results/leaderboard_report.h"
#include "reports/results/results_document.h"
#include "reports/results/summary_document.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// One of two: 1.3 to 98.7 %; none of two: 0 to 84.2 %; both: 15.8 to 100 %.
TEST(PublishedFiguresBlock, HasARowForEachFigure) {
  const std::string text = markdown(results_document(sample_figure_results(), ""));
  EXPECT_THAT(
      text,
      HasSubstr("### Published figures\n\n"
                "| pipeline | metric | published | simulated median | simulated 5-95 % | at "
                "percentile [95 % interval] | published is | source |\n"
                "|---|---|---:|---:|---:|---:|---|---|\n"
                "| yoon2021_both | AMD | at most 2.44 ms | 2.00 ms | [1.50, 2.50] ms | 50 % [1-99] "
                "| too few seeds | a paper |\n"
                "| yoon2021_both | AMD | at least 3.00 ms | 2.00 ms | [1.50, 2.50] ms | 100 % "
                "[16-100] | too few seeds | a paper |\n"));
  EXPECT_THAT(text, AllOf(HasSubstr("| 75.0 % | 75.0 % | [50.0, 100] % | 50 % [1-99] | too few"),
                          HasSubstr("Of a bound, holds: "),
                          HasSubstr("- yoon2021_both, AMD at most 2.44 ms: a rig in a hall\n")));
}

TEST(PublishedFiguresBlock, NamesEveryVerdict) {
  evaluation::Results results = sample_figure_results();
  using evaluation::FigureVerdict;
  results.published_figures[0].verdict = FigureVerdict::kHolds;
  results.published_figures[1].verdict = FigureVerdict::kInside;
  results.published_figures[2].verdict = FigureVerdict::kOutside;
  EXPECT_THAT(markdown(results_document(results, "")),
              AllOf(HasSubstr("| holds |"), HasSubstr("| inside | a paper"),
                    HasSubstr("| outside | a paper")));
}

TEST(PublishedFiguresBlock, IsALineEachOnOneScreen) {
  const std::string text = markdown(summary_document(sample_figure_results(), {}, {}));
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("- yoon2021_both, AMD: published at most 2.44 ms, simulated 2.00 ms "
                      "[1.50, 2.50] ms, at percentile 50 % [1-99]: too few seeds (a paper)\n"),
            HasSubstr("published at least 3.00 ms"), Not(HasSubstr("a rig in a hall"))));
}

TEST(PublishedFiguresBlock, IsNotThereWithoutFigures) {
  EXPECT_FALSE(published_figures_block(sample_results()).has_value());
  EXPECT_FALSE(published_figures_lines(sample_results()).has_value());
  EXPECT_THAT(markdown(results_document(sample_results(), "")),
              Not(HasSubstr("Published figures")));
}

TEST(PublishedFiguresBlock, IsInPagesAndLeaderboardsToo) {
  const evaluation::Results results = sample_figure_results();
  EXPECT_THAT(html(results_document(results, "").blocks), HasSubstr("at most 2.44 ms"));
  EXPECT_THAT(markdown(leaderboard_document(results, "")), HasSubstr("at most 2.44 ms"));
}

}  // namespace
}  // namespace simbench::reports
