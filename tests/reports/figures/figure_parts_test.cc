#include "reports/figures/figure_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace simbench::reports {
namespace {

using evaluation::kNan;

TEST(IsWide, IfPositiveValuesSpanMoreThanAFactorOfFifty) {
  const auto wide = [](std::vector<double> y) {
    FigurePanel made = panel("", "", "");
    made.series.push_back(series("", Mark::kLine, 0));
    made.series.back().y = std::move(y);
    return is_wide(made);
  };
  EXPECT_TRUE(wide({1, kNan, 51}));
  EXPECT_TRUE(wide({0, 1, 51}));
  EXPECT_FALSE(wide({1, 50}));
  EXPECT_FALSE(wide({-1, 1, 51}));
  EXPECT_FALSE(wide({0, 0}));
  EXPECT_FALSE(wide({}));
}

FigureSeries ramp(std::size_t size) {
  FigureSeries series;
  for (std::size_t i = 0; i < size; ++i) {
    series.x.push_back(static_cast<double>(i));
    series.y.push_back(static_cast<double>(i));
  }
  return series;
}

TEST(ThinTest, AShortSeriesStaysAsItIs) {
  const FigureSeries thin = thinned(ramp(100), 100);
  EXPECT_EQ(thin.x, ramp(100).x);
  EXPECT_EQ(thin.y, ramp(100).y);
}

TEST(ThinTest, ASingleSpikeStays) {
  FigureSeries series = ramp(100'000);
  std::fill(series.y.begin(), series.y.end(), 1.0);
  series.y[54'321] = 7;
  series.y[54'322] = -7;
  const FigureSeries thin = thinned(series, 100);
  EXPECT_LE(thin.x.size(), 100U);
  EXPECT_EQ(*std::max_element(thin.y.begin(), thin.y.end()), 7);
  EXPECT_EQ(*std::min_element(thin.y.begin(), thin.y.end()), -7);
}

TEST(ThinTest, KeepsLabelMarkAndColour) {
  FigureSeries series = ramp(1000);
  series.label = "host 3";
  series.mark = Mark::kSteps;
  series.colour = 5;
  const FigureSeries thin = thinned(series, 50);
  EXPECT_EQ(thin.label, "host 3");
  EXPECT_EQ(thin.mark, Mark::kSteps);
  EXPECT_EQ(thin.colour, 5);
}

// What must hold of any thinned series.
void check(const FigureSeries& series, std::size_t most) {
  const FigureSeries thin = thinned(series, most);
  ASSERT_EQ(thin.x.size(), thin.y.size());
  EXPECT_LE(thin.x.size(), std::max(most, std::size_t{0}));
  EXPECT_EQ(thin.x.front(), series.x.front());
  EXPECT_EQ(thin.x.back(), series.x.back());
  EXPECT_TRUE(std::is_sorted(thin.x.begin(), thin.x.end()));
  std::map<double, double> original;
  for (std::size_t i = 0; i < series.x.size(); ++i) original[series.x[i]] = series.y[i];
  double least = kNan;
  double greatest = kNan;
  for (const double y : series.y) {
    least = std::fmin(least, y);
    greatest = std::fmax(greatest, y);
  }
  double kept_least = kNan;
  double kept_greatest = kNan;
  for (std::size_t i = 0; i < thin.x.size(); ++i) {
    const double y = original.at(thin.x[i]);
    EXPECT_TRUE(thin.y[i] == y || (std::isnan(y) && std::isnan(thin.y[i])));
    kept_least = std::fmin(kept_least, thin.y[i]);
    kept_greatest = std::fmax(kept_greatest, thin.y[i]);
    if (i == 0 || std::isnan(thin.y[i]) || std::isnan(thin.y[i - 1])) continue;
    // No line is drawn across a gap.
    for (auto at = original.find(thin.x[i - 1]); at != original.find(thin.x[i]); ++at) {
      EXPECT_FALSE(std::isnan(at->second)) << "gap at " << at->first;
    }
  }
  EXPECT_TRUE(kept_least == least || std::isnan(least));
  EXPECT_TRUE(kept_greatest == greatest || std::isnan(greatest));
}

TEST(ThinTest, AnySeriesKeepsItsEndsExtremesAndGaps) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    boost::random::mt19937 random(seed);
    const auto draw = [&random](int low, int high) {
      return boost::random::uniform_int_distribution<int>(low, high)(random);
    };
    const auto size = static_cast<std::size_t>(draw(1, 2000));
    const auto most = static_cast<std::size_t>(draw(8, 300));
    const int gap_percent = draw(0, 1) == 0 ? 0 : draw(0, 100);
    FigureSeries series = ramp(size);
    for (double& y : series.y) y = draw(0, 99) < gap_percent ? kNan : draw(-1000, 1000);
    check(series, most);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace simbench::reports
