#include "evaluation/sweep/sweep_score.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "tests/nonempty.h"

namespace simbench::evaluation {
namespace {

// The same double to the last bit, or both NaN.
bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) ||
         std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

TEST(SweepScore, TextKeepsEveryBit) {
  constexpr std::uint64_t kSeed = 11;
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 500; ++round) {
    SweepScore score;
    for (double& value : score.values) value = std::bit_cast<double>(random());
    score.host_errors_ms = {std::bit_cast<double>(random()), 0.0, -0.0};
    const auto read = score_of(text_of(score));
    ASSERT_TRUE(read) << text_of(score);
    ASSERT_EQ(read->values.size(), score.values.size());
    for (std::size_t i = 0; i < nonempty(score.values).size(); ++i) {
      EXPECT_TRUE(same(read->values[i], score.values[i])) << i << " " << kSeed;
    }
    ASSERT_EQ(read->host_errors_ms.size(), 3U);
    for (std::size_t host = 0; host < 3; ++host) {
      EXPECT_TRUE(same(read->host_errors_ms[host], score.host_errors_ms[host]));
    }
  }
}

TEST(SweepScore, WhatDoesNotExistIsAnEmptyCell) {
  SweepScore score;
  score.at("amd_ms") = std::numeric_limits<double>::quiet_NaN();
  score.at("rmdv_ms") = 0.25;
  const std::string text = text_of(score);
  EXPECT_EQ(text.substr(0, 6), ",0.25,");
  EXPECT_EQ(text.back(), ';');
  EXPECT_TRUE(std::isnan(score_of(text)->at("amd_ms")));
}

TEST(SweepScore, OfClockRunsHasTheirColumns) {
  SweepScore score(ResultKind::kClockRuns);
  ASSERT_EQ(score.values.size(), sweep_metrics(ResultKind::kClockRuns).size());
  score.at("clock_spread_ms") = 0.125;
  score.at("recovery_s") = std::numeric_limits<double>::quiet_NaN();
  const std::string text = text_of(score);
  EXPECT_FALSE(score_of(text)) << "not of a capture";
  auto read = score_of(text, ResultKind::kClockRuns);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->at("clock_spread_ms"), 0.125);
  EXPECT_TRUE(std::isnan(read->at("recovery_s")));
}

TEST(SweepScore, RefusesOtherTexts) {
  const std::string text = text_of({});
  EXPECT_TRUE(score_of(text));
  EXPECT_FALSE(score_of(""));
  EXPECT_FALSE(score_of(text.substr(0, text.size() - 1)));
  EXPECT_FALSE(score_of(fmt::format("1,{}", text)));
  EXPECT_FALSE(score_of(text.substr(2)));
  EXPECT_FALSE(score_of(fmt::format("x{}", text.substr(1))));
  EXPECT_FALSE(score_of(text + "1,x"));
}

TEST(SweepScore, AFailedProgramIsTold) {
  SweepScore score;
  score.host_errors_ms = {0, 1};
  score.failed = "host 3, at 0.250000 s: chronyd: exited with status 1: a; b, c";
  const std::optional<SweepScore> read = score_of(text_of(score));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->failed, score.failed);
  EXPECT_EQ(read->host_errors_ms.size(), 2U);
  score.failed.clear();
  EXPECT_EQ(text_of(score).find(';', text_of(score).find(';') + 1), std::string::npos)
      << "others are as they were";
}

}  // namespace
}  // namespace simbench::evaluation
