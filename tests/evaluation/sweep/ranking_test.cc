#include "evaluation/sweep/ranking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace simbench::evaluation {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Three pipelines along five values and two words, with 16 seeds; `value(pipeline, x, word, seed)`
// is each run's error.
using Value = std::function<double(std::size_t, double, std::size_t, std::uint64_t)>;

SweepPlan plan_of_three() {
  SweepPlan plan;
  plan.scenario = "rig";
  plan.axes = {parse_axis("/x=1:5:1"), parse_axis("/word=one,two")};
  plan.pipelines = {"rising", "falling", "flat"};
  plan.seeds = 16;
  return plan;
}

Ranking ranking_of(const Value& value) {
  const SweepPlan plan = plan_of_three();
  std::vector<SweepScore> scores;
  for (std::size_t i = 0; i < plan.runs(); ++i) {
    const SweepRun run = plan.run(i);
    const std::vector<std::size_t> steps = plan.steps(run.point);
    SweepScore score;
    score.at("absolute_error_ms") =
        value(run.pipeline, 1.0 + static_cast<double>(steps[0]), steps[1], run.seed);
    scores.push_back(score);
  }
  return rank(plan, response(plan, scores), metric("absolute_error_ms"));
}

// Some noise that all pipelines share and a little that they do not.
double noise(std::size_t pipeline, std::uint64_t seed) {
  const auto s = static_cast<double>(seed);
  return std::exp(std::sin(7 * s) + 0.02 * std::sin(11 * s + static_cast<double>(pipeline)));
}

TEST(Ranking, SaysBetweenWhichValuesTheOrderFlips) {
  const Ranking ranking = ranking_of([](std::size_t pipeline, double x, std::size_t word,
                                        std::uint64_t seed) {
    const double cross = word == 0 ? 2.5 : 4.5;
    return noise(pipeline, seed) * (pipeline == 0 ? x / cross : pipeline == 1 ? cross / x : 50.0);
  });
  ASSERT_EQ(ranking.flips.size(), 2u);
  // Points count x first, words second: x = 2 and 3 with the first word, 4 and 5 with the second.
  EXPECT_EQ(ranking.flips[0].before, 0u);
  EXPECT_EQ(ranking.flips[0].after, 1u);
  EXPECT_EQ(ranking.flips[0].last, 2u);
  EXPECT_EQ(ranking.flips[0].first, 4u);
  EXPECT_EQ(ranking.flips[1].last, 7u);
  EXPECT_EQ(ranking.flips[1].first, 9u);
  EXPECT_THAT(ranking.points[0].order, ElementsAre(0, 1, 2));
  EXPECT_THAT(ranking.points[9].order, ElementsAre(1, 0, 2));
  EXPECT_THAT(ranking.points[0].is_apart, ElementsAre(true, true));
}

TEST(Ranking, WhatDiffersByChanceIsNotApartAndDoesNotFlip) {
  const Ranking ranking =
      ranking_of([](std::size_t pipeline, double x, std::size_t, std::uint64_t seed) {
        return std::exp(std::sin(13 * static_cast<double>(seed * (pipeline + 2)) + x));
      });
  EXPECT_THAT(ranking.flips, IsEmpty());
  for (const RankedPoint& point : ranking.points) {
    EXPECT_THAT(point.is_apart, ElementsAre(false, false)) << point.point;
  }
}

TEST(Ranking, EqualAndMissingValuesAreNoOrder) {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  const Ranking ranking =
      ranking_of([missing](std::size_t pipeline, double, std::size_t, std::uint64_t) {
        return pipeline == 0 ? missing : 1.0;
      });
  EXPECT_THAT(ranking.flips, IsEmpty());
  EXPECT_THAT(ranking.points[0].order, ElementsAre(1, 2, 0)) << "without a value: last";
  EXPECT_THAT(ranking.points[0].is_apart, ElementsAre(false, false));
}

}  // namespace
}  // namespace simbench::evaluation
