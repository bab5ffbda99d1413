#include "reports/figures/comparison_figures.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/nonempty.h"
#include "tests/reports/sample_archive.h"

namespace simbench::reports {
namespace {

using testing::ElementsAre;
using testing::Not;
using testing::StartsWith;

// B's AMD is A's plus 1 ms, so each difference is exactly that.
Comparison shifted(std::uint64_t seeds = 32) {
  const Archive a = sample_archive("monday", 3, seeds);
  Archive b = sample_archive("tuesday", 3, seeds);
  for (evaluation::Row& row : b.results.rows) {
    for (double& value : row.amd_ms.values) value += 1;
    row.amd_ms = evaluation::make_series(row.amd_ms.values);
  }
  return compare_archives(a, b, {});
}

TEST(ComparisonFigures, AreTwoForEachPipeline) {
  const std::vector<Figure> figures = comparison_figures(shifted());
  ASSERT_EQ(figures.size(), 4U);
  EXPECT_EQ(figures[0].id, kComparedDistributions);
  EXPECT_EQ(figures[1].id, kComparedDistributions);
  EXPECT_EQ(figures[2].id, kPairedDifferences);
  EXPECT_EQ(figures[0].pipeline, "plain");
  EXPECT_EQ(figures[1].pipeline, "good");
  for (const Figure& figure : figures) {
    EXPECT_THAT(figure.panels, Not(testing::IsEmpty()));
    EXPECT_NE(figure.caption, "");
  }
}

TEST(ComparisonFigures, DistributionsAscendSideBySide) {
  const Figure figure = comparison_figures(shifted())[0];
  const FigurePanel& amd = figure.panels[0];
  EXPECT_EQ(amd.title, "AMD");
  EXPECT_EQ(amd.y_label, "AMD (ms)");
  ASSERT_EQ(amd.series.size(), 2U);
  EXPECT_EQ(amd.series[0].label, "A: monday");
  EXPECT_EQ(amd.series[1].label, "B: tuesday");
  EXPECT_NE(amd.series[0].colour, amd.series[1].colour);
  for (std::size_t i = 0; i < nonempty(amd.series[0].y).size(); ++i) {
    EXPECT_NEAR(amd.series[1].y[i] - amd.series[0].y[i], 1, 1e-9);
  }
  EXPECT_TRUE(std::ranges::is_sorted(amd.series[0].y));
  EXPECT_EQ(amd.series[0].x.front(), 0);
  EXPECT_EQ(amd.series[0].x.back(), 100);
}

TEST(ComparisonFigures, DifferencesStandOverTheirSeeds) {
  const FigurePanel amd = comparison_figures(shifted())[2].panels[0];
  EXPECT_THAT(amd.title, StartsWith("AMD: worse"));
  ASSERT_EQ(amd.series.size(), 1U);
  ASSERT_EQ(amd.series[0].x.size(), 32U);
  EXPECT_EQ(amd.series[0].x.front(), 3);
  EXPECT_EQ(amd.series[0].x.back(), 34);
  for (const double difference : amd.series[0].y) EXPECT_NEAR(difference, 1, 1e-9);
  ASSERT_GE(amd.lines.size(), 2U);
  EXPECT_EQ(amd.lines[0].label, "no difference");
  EXPECT_EQ(amd.lines[0].at, 0);
  EXPECT_EQ(amd.lines[1].label, "mean 1.00 ms");
  EXPECT_NEAR(amd.lines[1].at, 1, 1e-9);
}

TEST(ComparisonFigures, SharesAreInPercent) {
  const std::vector<Figure> figures = comparison_figures(shifted());
  for (const FigurePanel& panel : figures[0].panels) {
    if (panel.title != "Recall") continue;
    EXPECT_EQ(panel.y_label, "recall (%)");
    EXPECT_EQ(panel.series[0].y.front(), 100);
    return;
  }
  FAIL() << "no panel of the recall";
}

// Without a verdict there is no interval to draw.
TEST(ComparisonFigures, OfFewSeedsHaveTheMeanAlone) {
  Archive a = sample_archive("monday", 1, 3);
  Archive b = a;
  b.path = "tuesday";
  b.results.rows[0].amd_ms = evaluation::make_series({1, 22, 3});
  const FigurePanel amd = comparison_figures(compare_archives(a, b, {}))[2].panels[0];
  EXPECT_EQ(amd.lines.size(), 2U);
}

TEST(ComparisonFigures, PipelinesOfOneArchiveAreNamed) {
  const Archive archive = sample_archive("monday");
  const Figure figure = comparison_figures(compare_pipelines(archive, "plain", "good", {}))[0];
  EXPECT_EQ(figure.pipeline, "good / plain");
  EXPECT_EQ(figure.panels[0].series[0].label, "A: plain");
  EXPECT_EQ(figure.panels[0].series[1].label, "B: good");
  const std::vector<Figure> with_baseline =
      comparison_figures(compare_with_baseline(archive, "plain", {}));
  EXPECT_EQ(with_baseline[0].pipeline, "good");
}

// A seed without a value is a gap of the differences, and is in no distribution.
TEST(ComparisonFigures, LeaveOutWhatHasNoValue) {
  Archive a = sample_archive("monday", 1, 12);
  Archive b = sample_archive("tuesday", 1, 12);
  b.results.rows[0].amd_ms.values[4] = evaluation::kNan;
  const std::vector<Figure> figures = comparison_figures(compare_archives(a, b, {}));
  EXPECT_EQ(figures[0].panels[0].series[1].y.size(), 11U);
  EXPECT_TRUE(std::isnan(figures[2].panels[0].series[0].y[4]));
  for (evaluation::Row* row : {&a.results.rows[0]}) {
    for (evaluation::Series* series :
         {&row->amd_ms, &row->rmdv_ms, &row->absolute_error_ms, &row->seed_recall}) {
      std::ranges::fill(series->values, evaluation::kNan);
    }
  }
  EXPECT_NE(comparison_figures(compare_archives(a, b, {}))[0].absent, "");
}

}  // namespace
}  // namespace simbench::reports
