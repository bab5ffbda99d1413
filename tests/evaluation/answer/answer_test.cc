#include "evaluation/answer/answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace simbench::evaluation {
namespace {

// Twelve seeds around a value.
std::vector<double> seeds_around(double value) {
  std::vector<double> values;
  for (int seed = 0; seed < 12; ++seed) values.push_back(value * (1 + 0.01 * (seed % 5)));
  return values;
}

Row amd_row(const std::string& name, const std::string& host_sync, const std::string& device_time,
            const std::vector<double>& amd_ms) {
  Row row;
  row.pipeline = name;
  row.host_sync = host_sync;
  row.device_time = device_time;
  row.gathering = "yoon2021";
  row.amd_ms = make_series(amd_ms);
  row.sets = {.emitted = 120,
              .pure = 120,
              .complete_pulses = 120,
              .due_pulses = 120,
              .exposed_pulses = 120};
  std::vector<double> errors;
  for (const double value : amd_ms) errors.push_back(10 / value);
  row.absolute_error_ms = make_series(errors);
  return row;
}

Results sample() {
  Results results;
  results.rows = {amd_row("far", "ntp", "regression_30", seeds_around(8)),
                  amd_row("best", "two_way_hull", "regression_30", seeds_around(2)),
                  amd_row("equal", "pps", "regression_30", seeds_around(2)),
                  amd_row("clocks", "oracle", "regression_30", seeds_around(1)),
                  amd_row("all", "oracle", "oracle", seeds_around(0.1)),
                  amd_row("order", "free_running", "sensor_normalised", seeds_around(0.5))};
  return results;
}

std::vector<std::string> names_of(const std::vector<ComparedRow>& rows) {
  std::vector<std::string> all;
  for (const ComparedRow& row : rows) all.push_back(row.row->pipeline);
  return all;
}

TEST(Answer, TheBestIsOneThatARigCanRun) {
  const Results results = sample();
  const Answer answer = answer_of(results);
  ASSERT_NE(answer.best, nullptr);
  EXPECT_EQ(answer.best->pipeline, "best");
  EXPECT_EQ(answer.ranked, 3U);
  EXPECT_THAT(names_of(answer.not_told_apart), testing::ElementsAre("equal"));
  ASSERT_TRUE(answer.next);
  EXPECT_EQ(answer.next->row->pipeline, "far");
  EXPECT_NEAR(answer.next->to_best.ratio.value, 4, 1e-9);
  EXPECT_EQ(answer.seeds_needed, 0U);
}

TEST(Answer, TheLimitHasPerfectHostClocksAndAllElseAlike) {
  const Results results = sample();
  const Answer answer = answer_of(results);
  ASSERT_TRUE(answer.limit);
  EXPECT_EQ(answer.limit->row->pipeline, "clocks");
  EXPECT_EQ(answer.limit->to_best.verdict, Verdict::kBetter);
  EXPECT_NEAR(answer.times_limit, 2, 1e-9);
}

TEST(Answer, ARowThatDiffersInMoreThanTheClocksIsNoLimit) {
  Results results = sample();
  results.rows.erase(results.rows.begin() + 3);
  EXPECT_FALSE(answer_of(results).limit);
}

TEST(Answer, ARowBelowItsLimitIsToldFromIt) {
  Results results = sample();
  results.rows[3].amd_ms = make_series(seeds_around(3));
  const Answer answer = answer_of(results);
  ASSERT_TRUE(answer.limit);
  EXPECT_EQ(answer.limit->to_best.verdict, Verdict::kWorse);
  EXPECT_NEAR(answer.times_limit, 2.0 / 3, 1e-9);
}

TEST(Answer, OfASingleCameraTheErrorRanks) {
  Results results = sample();
  for (Row& row : results.rows) row.amd_ms = make_series(std::vector<double>(12, kNan));
  const Answer answer = answer_of(results);
  EXPECT_EQ(answer.ranked_by, RankedBy::kAbsoluteError);
  ASSERT_NE(answer.best, nullptr);
  EXPECT_EQ(answer.best->pipeline, "far");  // 10 / value
}

TEST(Answer, ThereIsNoneWithoutAPipelineThatARigCanRun) {
  Results results = sample();
  results.rows.erase(results.rows.begin(), results.rows.begin() + 3);
  EXPECT_EQ(answer_of(results).best, nullptr);
  EXPECT_EQ(answer_of({}).best, nullptr);
}

TEST(Answer, FewSeedsTellNothingApartAndSayHowManyWould) {
  Results results = sample();
  for (Row& row : results.rows) {
    row.amd_ms = make_series({row.amd_ms.values[0], row.amd_ms.values[1]});
  }
  const Answer answer = answer_of(results);
  EXPECT_THAT(names_of(answer.not_told_apart), testing::ElementsAre("equal", "far"));
  EXPECT_FALSE(answer.next);
  EXPECT_EQ(answer.seeds_needed, fewest_pairs(1)) << "equal differs in no seed";
  EXPECT_EQ(answer.not_told_apart[1].to_best.higher, 2U);
}

TEST(Answer, FailedRowsAreNamedAndNotRanked) {
  Results results = sample();
  results.rows[1].sets.pure = 0;             // the best
  results.rows[2].unsynchronised_hosts = 1;  // its equal
  const Answer answer = answer_of(results);
  ASSERT_NE(answer.best, nullptr);
  EXPECT_EQ(answer.best->pipeline, "far");
  EXPECT_EQ(answer.ranked, 1U);
  EXPECT_THAT(answer.not_told_apart, testing::IsEmpty());
  ASSERT_EQ(answer.failed.size(), 2U);
  EXPECT_EQ(answer.failed[0].row->pipeline, "best");
  EXPECT_EQ(answer.failed[0].reason, "no gathered set is of one pulse");
  EXPECT_EQ(answer.failed[1].reason, "hosts were not synchronised (1 over all seeds)");
}

// Rows that differ in gathering alone have one AMD.
TEST(Answer, OfOneMedianTheRecallDecides) {
  Results results = sample();
  for (const std::size_t row : {1, 2}) results.rows[row].recall = 0.1 * static_cast<double>(row);
  EXPECT_EQ(answer_of(results).best->pipeline, "equal");
}

// 24.0 against 25.1 us of absolute error; 28 against 13 us of AMD, 6.8 against 0.37 of the clocks.
TEST(Answer, WhatIsWorseInAmdAndClocksIsNotTheBestByItsAbsoluteError) {
  Results results;
  results.ranked_by = RankedBy::kAbsoluteError;
  const auto add = [&results](const char* name, double error_ms, double amd_ms, double host_ms) {
    Row& row = results.rows.emplace_back(
        amd_row(name, "two_way_hull", "regression_30", seeds_around(amd_ms)));
    row.absolute_error_ms = make_series(seeds_around(error_ms));
    row.bias_ms = make_series(seeds_around(-0.99 * error_ms));
    row.host_error_ms = make_series(seeds_around(host_ms));
  };
  add("naive", 0.0240, 0.028, 0.0068);
  add("hull", 0.0251, 0.013, 0.00037);
  Answer answer = answer_of(results);
  EXPECT_EQ(answer.best->pipeline, "hull");
  ASSERT_TRUE(answer.shared_bias_ms);
  EXPECT_NEAR(*answer.shared_bias_ms, -0.99 * 0.0246 * 1.02, 0.001);
  // Without a calibration the constant is no longer about the same: then the small error is real.
  results.rows[1].absolute_error_ms = make_series(seeds_around(25));
  results.rows[1].bias_ms = make_series(seeds_around(-25));
  answer = answer_of(results);
  EXPECT_EQ(answer.best->pipeline, "naive");
  EXPECT_FALSE(answer.shared_bias_ms);
}

}  // namespace
}  // namespace simbench::evaluation
