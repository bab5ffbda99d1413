#include "algorithms/host_sync/chrony_regression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithms/host_sync/chrony_robust_regression.h"

namespace simbench {
namespace {

using Values = std::vector<double>;

void expect_near(double actual, double expected, const std::string& what) {
  EXPECT_NEAR(actual, expected, 1e-9 * std::abs(expected)) << what;
}

TEST(ChronyRegressionVectors, AllFortyAgree) {
  const std::filesystem::path path =
      std::filesystem::path(SIMBENCH_SOURCE_DIR) / "../shared/vectors/chrony_regress_golden.json";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not run: no " << path;
  std::ifstream file(path);
  const nlohmann::json sets = nlohmann::json::parse(file);
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
      expect_near(line.intercept, values.at("b0"), name + " b0");
      expect_near(line.slope, values.at("b1"), name + " b1");
      expect_near(line.variance, values.at("s2"), name + " s2");
      expect_near(line.intercept_sd, values.at("sb0"), name + " sb0");
      expect_near(line.slope_sd, values.at("sb1"), name + " sb1");
    };
    line_agrees(best->line, expected);

    const auto weighted = weighted_regression(used_x, used_y, w);
    ASSERT_TRUE(weighted) << name;
    line_agrees(*weighted, set.at("weighted"));

    const auto robust = robust_regression(used_x, used_y, 1e-12);
    const nlohmann::json& robust_expected = set.at("robust");
    ASSERT_EQ(robust.has_value(), robust_expected.at("ok") == 1) << name;
    EXPECT_EQ(robust->start, robust_expected.at("start").get<std::size_t>()) << name;
    EXPECT_EQ(robust->runs, robust_expected.at("runs").get<int>()) << name;
    expect_near(robust->intercept, robust_expected.at("b0"), name + " robust b0");
    expect_near(robust->slope, robust_expected.at("b1"), name + " robust b1");

    expect_near(median(used_y), set.at("median_y"), name + " median");
  }
}

}  // namespace
}  // namespace simbench
