#include "evaluation/scoring/published_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "evaluation/scoring/results.h"

namespace simbench::evaluation {
namespace {

using scenarios::PublishedFigure;
using testing::IsNan;

// `below` seeds have an AMD of 1 ms, `above` one of 3 ms.
Row row_with_amd(int below, int above) {
  std::vector<double> values(static_cast<std::size_t>(below), 1);
  values.resize(static_cast<std::size_t>(below + above), 3);
  Row row;
  row.pipeline = "mine";
  row.amd_ms = make_series(std::move(values));
  return row;
}

FigureVerdict verdict_of(const PublishedFigure& figure, int below, int above) {
  return compare_figure(figure, row_with_amd(below, above)).verdict;
}

PublishedFigure at_most(double bound) {
  return {.pipeline = "mine", .metric = "amd_ms", .at_most = bound};
}
PublishedFigure at_least(double bound) {
  return {.pipeline = "mine", .metric = "amd_ms", .at_least = bound};
}
PublishedFigure value(double number) {
  return {.pipeline = "mine", .metric = "amd_ms", .value = number};
}

TEST(PublishedFigure, HasItsPercentileAmongTheSeeds) {
  const FigureComparison compared = compare_figure(at_most(2), row_with_amd(3, 1));
  EXPECT_EQ(compared.figure.at_most, 2);
  EXPECT_DOUBLE_EQ(compared.percentile.percent, 75);
  EXPECT_DOUBLE_EQ(compared.percentile.low, 100 * binomial_interval(3, 4).low);
  EXPECT_DOUBLE_EQ(compared.percentile.high, 100 * binomial_interval(3, 4).high);
  EXPECT_DOUBLE_EQ(compared.kept.percent, 75);
  EXPECT_DOUBLE_EQ(compare_figure(at_least(2), row_with_amd(3, 1)).kept.percent, 25);
  EXPECT_DOUBLE_EQ(compare_figure(at_most(1), row_with_amd(3, 1)).kept.percent, 75);  // equal: kept
  EXPECT_THAT(compare_figure(value(2), row_with_amd(3, 1)).kept.percent, IsNan());
}

// All of n seeds keep it: the interval's lower end is 0.025^(1/n), at least 95 % from 72 seeds on.
TEST(PublishedFigure, ABoundHoldsIfNearlyAllSeedsKeepIt) {
  EXPECT_EQ(verdict_of(at_most(2), kFewestOutside, 0), FigureVerdict::kHolds);
  EXPECT_EQ(verdict_of(at_most(2), kFewestOutside - 1, 0), FigureVerdict::kTooFewSeeds);
  EXPECT_EQ(verdict_of(at_least(2), 0, kFewestOutside), FigureVerdict::kHolds);
  EXPECT_EQ(verdict_of(at_least(2), 0, kFewestOutside - 1), FigureVerdict::kTooFewSeeds);
}

// None of n keeps it: the upper end is 1 - 0.025^(1/n), below 5 % from 72 seeds on.
TEST(PublishedFigure, ABoundFailsIfNearlyAllSeedsBreakIt) {
  EXPECT_EQ(verdict_of(at_most(2), 0, kFewestOutside - 1), FigureVerdict::kTooFewSeeds);
  EXPECT_EQ(verdict_of(at_most(2), 0, kFewestOutside), FigureVerdict::kFails);
  EXPECT_EQ(verdict_of(at_least(2), kFewestOutside, 0), FigureVerdict::kFails);
}

TEST(PublishedFigure, ABoundIsInsideIfManySeedsKeepItAndManyDoNot) {
  // 90 % of a thousand seeds keep it: from 88 to 92 %.
  EXPECT_EQ(verdict_of(at_most(2), 900, 100), FigureVerdict::kInside);
  EXPECT_EQ(verdict_of(at_least(2), 900, 100), FigureVerdict::kInside);
  EXPECT_EQ(verdict_of(at_most(2), 1, 1), FigureVerdict::kTooFewSeeds);
  EXPECT_EQ(verdict_of(at_most(2), 50, 950), FigureVerdict::kTooFewSeeds);
  EXPECT_EQ(verdict_of(at_most(2), 970, 30), FigureVerdict::kHolds);
}

TEST(PublishedFigure, AValueIsInsideOrOutside) {
  EXPECT_EQ(verdict_of(value(2), 2, 2), FigureVerdict::kInside);
  EXPECT_EQ(verdict_of(value(2), 1, 1), FigureVerdict::kTooFewSeeds);
  EXPECT_EQ(verdict_of(value(2), 0, kFewestOutside), FigureVerdict::kOutside);
  EXPECT_EQ(verdict_of(value(2), kFewestOutside, 0), FigureVerdict::kOutside);
}

TEST(PublishedFigure, WithoutSeedsTellsNothing) {
  for (const PublishedFigure& figure : {at_most(2), at_least(2), value(2)}) {
    const FigureComparison compared = compare_figure(figure, row_with_amd(0, 0));
    EXPECT_EQ(compared.verdict, FigureVerdict::kTooFewSeeds);
    EXPECT_THAT(compared.percentile.percent, IsNan());
  }
}

TEST(PublishedFigure, IsComparedIfItsPipelineHasARow) {
  PublishedFigure other = at_most(2);
  other.pipeline = "another";
  const std::vector<PublishedFigure> figures = {other, value(2), at_most(2)};
  const std::vector<Row> rows = {row_with_amd(2, 2)};
  const std::vector<FigureComparison> compared = compare_figures(figures, rows);
  ASSERT_EQ(compared.size(), 2U);
  EXPECT_EQ(compared[0].figure.value, 2);
  EXPECT_EQ(compared[1].figure.at_most, 2);
}

}  // namespace
}  // namespace simbench::evaluation
