#include "reports/figures/stability_figure.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>

#include "tests/nonempty.h"

namespace simbench::reports {
namespace {

using testing::HasSubstr;

// 300 s of a clock with the same noise in every run.
StabilityFinding clock_with_noise() {
  evaluation::ClockLog log{.path = "a.csv", .format = "csv"};
  unsigned state = 1;
  for (int i = 0; i < 300; ++i) {
    state = state * 1664525U + 1013904223U;
    log.points.push_back({Microseconds(1'000'000 * i), 1e-17 * static_cast<double>(state)});
  }
  return {.log = evaluation::stability_of_log(log, {})};
}

TEST(StabilityFigure, HasCurvesWithIntervalsAndLimits) {
  const Figure figure = stability_figure({clock_with_noise()}, {evaluation::mask_named("prtc_a")});
  ASSERT_EQ(figure.panels.size(), 3U);
  EXPECT_EQ(figure.panels[0].series.size(), 1U) << "no mask limits ADEV";
  for (const std::size_t panel : {1U, 2U}) {
    ASSERT_EQ(figure.panels[panel].series.size(), 2U);
    EXPECT_THAT(figure.panels[panel].series[1].label, HasSubstr("ITU-T G.8272 PRTC-A"));
  }
  for (const FigurePanel& panel : figure.panels) {
    const FigureSeries& curve = panel.series[0];
    EXPECT_EQ(curve.label, "a.csv");
    for (std::size_t i = 0; i < nonempty(curve.low).size() && i < 4; ++i) {
      EXPECT_LT(curve.low[i], curve.y[i]);
      EXPECT_GT(curve.high[i], curve.y[i]);
    }
    if (panel.title == figure.panels[1].title) break;
  }
  EXPECT_TRUE(figure.panels[2].series[0].low.empty()) << "MTIE has no interval";
}

TEST(StabilityFigure, ALimitIsItsFormulaFromTheFirstTauOn) {
  const evaluation::MaskLimit& limit = evaluation::mask_named("prtc_a").limits.at(1);
  const FigureSeries line = limit_line(limit, "MTIE", 3, 2);
  EXPECT_EQ(line.colour, 3);
  EXPECT_EQ(line.x.front(), 2);
  EXPECT_DOUBLE_EQ(line.x.back(), 10'000);
  for (std::size_t i = 0; i < nonempty(line.x).size(); ++i) {
    EXPECT_NEAR(line.y[i], limit_at(limit, line.x[i]), 2e-3 * line.y[i]);
  }
  // Between two points of the drawn line the sum differs by less than a line's width.
  const double middle = std::sqrt(line.x[10] * line.x[11]);
  EXPECT_NEAR(std::sqrt(line.y[10] * line.y[11]), limit_at(limit, middle), 0.01 * line.y[10]);
}

TEST(StabilityFigure, ALimitAtOneTauIsAPoint) {
  const Figure figure =
      stability_figure({clock_with_noise()}, {evaluation::limits_mask({"mtie@10s=50ns"})});
  const FigureSeries& limit = figure.panels.at(2).series.at(1);
  EXPECT_EQ(limit.mark, Mark::kPoints);
  ASSERT_EQ(limit.x.size(), 1U);
  EXPECT_EQ(limit.x[0], 10);
  EXPECT_DOUBLE_EQ(limit.y[0], 50e-6);
}

// Two pieces of 1 us with a pause between, in the unit that fits, with what is said of them.
TEST(TimeErrorFigure, HasThePointsWithTheirGapsAndSteps) {
  evaluation::ClockLog log{.path = "a.csv", .format = "csv"};
  for (int i = 0; i < 200; ++i) {
    const int second = i < 100 ? i : i + 50;
    log.points.push_back(
        {Microseconds(1'000'000 * second), (i % 2 == 0 ? 1e-6 : 1.01e-6) + (i < 50 ? 0 : 5e-6)});
  }
  const StabilityFinding finding{.log = evaluation::stability_of_log(log, {})};
  const Figure figure = time_error_figure({finding}, {evaluation::limits_mask({"max_te=2us"})});
  ASSERT_EQ(figure.panels.size(), 1U);
  const FigurePanel& panel = figure.panels[0];
  EXPECT_EQ(panel.title, "a.csv");
  EXPECT_EQ(panel.y_label, "time error (us)");
  const FigureSeries& line = panel.series.at(0);
  ASSERT_EQ(line.x.size(), 201U);
  EXPECT_EQ(line.x[0], 0);
  EXPECT_NEAR(line.y[0], 1, 1e-9);
  EXPECT_TRUE(std::isnan(line.y[100])) << "between the pieces";
  EXPECT_EQ(line.x[101], 150);
  EXPECT_NEAR(line.y[200], 6.01, 1e-9);
  ASSERT_EQ(panel.lines.size(), 3U);
  EXPECT_TRUE(panel.lines[0].vertical);
  EXPECT_EQ(panel.lines[0].at, 50);
  EXPECT_THAT(panel.lines[0].label, HasSubstr("step of "));
  EXPECT_NEAR(panel.lines[1].at, 2, 1e-9);
  EXPECT_NEAR(panel.lines[2].at, -2, 1e-9);
}

TEST(TimeErrorFigure, APanelForEachClock) {
  EXPECT_EQ(time_error_figure({clock_with_noise(), clock_with_noise()}, {}).panels.size(), 2U);
}

TEST(TimeErrorFigure, SummariesHaveNoPoints) {
  StabilityFinding finding = clock_with_noise();
  finding.log.are_summaries = true;
  finding.log.stability.series = {};
  EXPECT_THAT(time_error_figure({finding}, {}).absent, HasSubstr("Summaries"));
}

}  // namespace
}  // namespace simbench::reports
