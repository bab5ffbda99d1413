#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithms/host_sync/chrony/chrony_source_stats.h"
#include "laws/median.h"
#include "tests/data/test_data.h"

namespace simbench {
namespace {

using Values = std::vector<double>;

void expect_nearly(double actual, double expected, const std::string& what) {
  EXPECT_NEAR(actual, expected, 1e-9 * std::abs(expected)) << what;
}

TEST(ChronyRegressionVectors, AllFortyAgree) {
  const nlohmann::json sets = test_data_json("vectors/chrony_regress_golden.json");
  ASSERT_EQ(sets.size(), 40U);
  for (std::size_t index = 0; index < sets.size(); ++index) {
    const nlohmann::json& set = sets[index];
    const std::string name = "set " + std::to_string(index);
    const auto x = set.at("x").get<Values>();
    const auto y = set.at("y").get<Values>();
    const auto w = set.at("w").get<Values>();
    const auto extra = set.at("m_extra").get<std::size_t>();
    const std::span<const double> used_x = std::span(x).subspan(extra);
    const std::span<const double> used_y = std::span(y).subspan(extra);

    const auto best = best_regression(x, y, w, extra, set.at("min_samples").get<std::size_t>());
    const nlohmann::json& expected = set.at("best");
    ASSERT_EQ(best.has_value(), expected.at("ok") == 1) << name;
    EXPECT_EQ(best->start, expected.at("start").get<std::size_t>()) << name;
    EXPECT_EQ(best->runs, expected.at("runs").get<int>()) << name;
    EXPECT_EQ(best->degrees_of_freedom, expected.at("dof").get<int>()) << name;
    const auto line_agrees = [&](const WeightedLine& line, const nlohmann::json& values) {
      expect_nearly(line.intercept, values.at("b0"), name + " b0");
      expect_nearly(line.slope, values.at("b1"), name + " b1");
      expect_nearly(line.variance, values.at("s2"), name + " s2");
      expect_nearly(line.intercept_sd, values.at("sb0"), name + " sb0");
      expect_nearly(line.slope_sd, values.at("sb1"), name + " sb1");
    };
    line_agrees(best->line, expected);

    const auto weighted = weighted_regression(used_x, used_y, w);
    ASSERT_TRUE(weighted) << name;
    line_agrees(*weighted, set.at("weighted"));

    Values values(used_y.begin(), used_y.end());
    expect_nearly(median_in_place(values), set.at("median_y"), name + " median");
  }
}

struct Points {
  Values x;
  Values y;
  Values w;
};

// y = 2 - 0.5 x with noise, and a rate of its own before `break_at`.
Points line_with_noise(std::size_t n, std::size_t break_at, double slope_before, unsigned seed) {
  boost::random::mt19937 engine(seed);
  boost::random::normal_distribution<double> noise(0, 1e-3);
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i) - static_cast<double>(n - 1);
    const double x_break = static_cast<double>(break_at) - static_cast<double>(n - 1);
    const double y = i < break_at ? 2 - 0.5 * x_break + slope_before * (x - x_break) : 2 - 0.5 * x;
    points.x.push_back(x);
    points.y.push_back(y + noise(engine));
    points.w.push_back(1);
  }
  return points;
}

TEST(ChronyRegression, AnExactLineIsFound) {
  const Values x = {-6, -3, -1, 0};
  const Values y = {5, 3.5, 2.5, 2};
  const Values w = {1, 4, 2, 9};
  const auto fit = weighted_regression(x, y, w);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->intercept, 2, 1e-15);
  EXPECT_NEAR(fit->slope, -0.5, 1e-15);
  EXPECT_NEAR(fit->slope_sd, 0, 1e-15);
}

TEST(ChronyRegression, AHeavyWeightTakesAPointOut) {
  const Values x = {-3, -2, -1, 0};
  const Values y = {3, 2, 100, 0};
  const auto fit = weighted_regression(x, y, Values{1, 1, 1e12, 1});
  EXPECT_NEAR(fit->slope, -1, 1e-9);
}

TEST(ChronyRegression, SlopeErrorIsTheTextbooks) {
  // Equal weights, residuals +-1 about y = 0: s^2 = 4/2, sum (x - mean)^2 = 5.
  const auto fit = weighted_regression(Values{0, 1, 2, 3}, Values{1, -1, -1, 1}, Values(4, 1.0));
  EXPECT_NEAR(fit->slope, 0, 1e-15);
  EXPECT_NEAR(fit->slope_sd, std::sqrt(2.0 / 5), 1e-15);
  EXPECT_NEAR(fit->intercept_sd, std::sqrt(2.0 / 4 + 1.5 * 1.5 * 2 / 5), 1e-15);
  EXPECT_NEAR(fit->variance, 2, 1e-15);
}

TEST(ChronyRegression, TheRunsTestDropsThePointsBeforeARateChange) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Points points = line_with_noise(60, 30, 0.5, seed);
    const auto best = best_regression(points.x, points.y, points.w, 0, 3);
    ASSERT_TRUE(best) << "seed " << seed;
    EXPECT_GE(best->start, 25U) << "seed " << seed;
    EXPECT_NEAR(best->line.slope, -0.5, 0.01) << "seed " << seed;
    EXPECT_NEAR(best->line.intercept, 2, 0.02) << "seed " << seed;
  }
}

TEST(ChronyRegression, OneLineIsKeptWholeAsOftenAsTheTestSays) {
  int whole = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const Points points = line_with_noise(40, 0, 0, seed);
    if (best_regression(points.x, points.y, points.w, 0, 3)->start == 0) ++whole;
  }
  // Rejected at 5 to 11 % (the binomial's steps); residuals of a fit have a few more runs.
  EXPECT_GE(whole, 400 * 0.85);
  EXPECT_LE(whole, 400);
}

TEST(ChronyRegression, MinSamplesAreLeft) {
  const Points points = line_with_noise(20, 19, 5, 3);
  EXPECT_LE(best_regression(points.x, points.y, points.w, 0, 12)->start, 8U);
}

TEST(ChronyRegression, TooFewOrCoincidentPointsGiveNothing) {
  EXPECT_FALSE(weighted_regression(Values{0, 1}, Values{0, 1}, Values{1, 1}));
  EXPECT_FALSE(weighted_regression(Values(5, 3.0), Values(5, 1.0), Values(5, 1.0)));
  EXPECT_FALSE(best_regression(Values(5, 3.0), Values(5, 1.0), Values(5, 1.0), 0, 3));
  EXPECT_FALSE(best_regression(Values{}, Values{}, Values{}, 0, 3));
  EXPECT_FALSE(second_slope(Values(5, 3.0), Values(5, 1.0), Values(5, 1.0)));
}

TEST(ChronyRegression, TheSecondSlopeIsFoundBesideTheFirst) {
  Values time;
  Values delay;
  Values offset;
  for (int i = 0; i < 10; ++i) {
    time.push_back(i);
    delay.push_back((i * 7) % 5);
    offset.push_back(3 - 0.2 * time.back() + 0.5 * delay.back());
  }
  EXPECT_NEAR(*second_slope(time, delay, offset), 0.5, 1e-12);
  EXPECT_FALSE(second_slope(time, time, offset)) << "undetermined";
}

TEST(ChronyRegression, CriticalRunsAreTheQuantileOfTheBinomial) {
  EXPECT_EQ(critical_runs(7), 0);
  EXPECT_EQ(critical_runs(8), 2);   // P(runs <= 1) = 0.8 %, <= 2: 6.3 %
  EXPECT_EQ(critical_runs(14), 5);  // P(runs <= 4) = 4.6 %, <= 5: 13 %
  EXPECT_EQ(critical_runs(100), 42);
}

TEST(ChronyRegression, StudentsQuantiles) {
  EXPECT_NEAR(student_t_9995(1), 636.62, 0.01);
  EXPECT_NEAR(student_t_9995(10), 4.587, 0.001);
  EXPECT_EQ(student_t_9995(500), student_t_9995(62));
}

}  // namespace
}  // namespace simbench
