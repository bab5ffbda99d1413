#include <gmock/gmock.h>

#include "reports/reconstruction/reconstruction_document.h"
#include "tests/reports/sample_reconstruction.h"

namespace simbench::reports {
namespace {

using testing::ElementsAre;

TEST(ReconstructionFigure, HasACurveForEachSpeed) {
  const Figure figure = reconstruction_figure(sample_reconstruction());
  ASSERT_EQ(figure.panels.size(), 2U);
  const FigurePanel& panel = figure.panels[0];
  ASSERT_EQ(panel.series.size(), 2U);
  EXPECT_EQ(panel.series[0].label, "0.60 m/s");
  EXPECT_EQ(panel.series[1].label, "1.20 m/s");
  EXPECT_EQ(panel.series[1].colour, 1);
  EXPECT_THAT(panel.series[1].x, ElementsAre(0, 10, 100));
  EXPECT_THAT(panel.series[1].y, ElementsAre(2, 2, 2.9));
  ASSERT_EQ(panel.lines.size(), 2U);  // the oracle has no published value
  EXPECT_EQ(panel.lines[0].label, "published ntp_last_set: 9.70");
  EXPECT_EQ(panel.lines[1].at, 2.3942);
}

TEST(ReconstructionFigure, HasTheErrorOverTheSpeed) {
  const Figure figure = reconstruction_figure(sample_reconstruction());
  const FigurePanel& panel = figure.panels[1];
  EXPECT_THAT(panel.series[0].x, ElementsAre(1.2, 2.4));
  EXPECT_THAT(panel.series[0].y, ElementsAre(7, 9.5));
  EXPECT_EQ(panel.lines[0].at, 9.703);
}

TEST(ReconstructionFigure, ASubjectThatDoesNotWalkHasAFactor) {
  auto results = sample_reconstruction();
  for (auto& point : results.curve) point.speed_m_per_s = 0;
  for (auto& point : results.speed_needed->points) point.speed_m_per_s = 0;
  const Figure figure = reconstruction_figure(results);
  EXPECT_EQ(figure.panels[0].series[0].label, "x 0.5");
  EXPECT_THAT(figure.panels[1].series[0].x, ElementsAre(1, 2));
  EXPECT_EQ(figure.panels[1].x_label, "factor on the stated speed");
}

TEST(ReconstructionFigure, WithoutACurveThereIsNothingToDraw) {
  auto results = sample_reconstruction();
  results.curve.clear();
  results.speed_needed.reset();
  const Figure figure = reconstruction_figure(results);
  EXPECT_TRUE(figure.panels.empty());
  EXPECT_EQ(figure.absent, "the curve was not requested");
}

}  // namespace
}  // namespace simbench::reports
