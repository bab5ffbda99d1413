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

std::vector<std::string> names_of(const std::vector<const Row*>& rows) {
  std::vector<std::string> all;
  for (const Row* row : rows) all.push_back(row->pipeline);
  return all;
}

TEST(Answer, TellsWhatARigCanRun) {
  const Results results = sample();
  EXPECT_EQ(standing_of(results.rows[0]), RowStanding::kRunnable);
  EXPECT_EQ(standing_of(results.rows[3]), RowStanding::kLimit);
  EXPECT_EQ(standing_of(results.rows[4]), RowStanding::kLimit);
  EXPECT_EQ(standing_of(results.rows[5]), RowStanding::kReference);
}

TEST(Answer, TheBestIsOneThatARigCanRun) {
  const Results results = sample();
  const Answer answer = answer_of(results, RankedBy::kAmd);
  ASSERT_NE(answer.best, nullptr);
  EXPECT_EQ(answer.best->pipeline, "best");
  EXPECT_EQ(answer.runnable, 3U);
  EXPECT_THAT(names_of(answer.equals), testing::ElementsAre("equal"));
  ASSERT_NE(answer.next, nullptr);
  EXPECT_EQ(answer.next->pipeline, "far");
  EXPECT_NEAR(answer.to_next.ratio.value, 4, 1e-9);
}

TEST(Answer, TheLimitHasPerfectHostClocksAndAllElseAlike) {
  const Results results = sample();
  const Answer answer = answer_of(results, RankedBy::kAmd);
  ASSERT_NE(answer.limit, nullptr);
  EXPECT_EQ(answer.limit->pipeline, "clocks");
  EXPECT_TRUE(answer.limit_is_host_sync);
  EXPECT_NEAR(answer.times_limit, 2, 1e-9);
}

TEST(Answer, WithoutSuchARowTheLimitIsTheBestThatKnowsTheTruth) {
  Results results = sample();
  results.rows.erase(results.rows.begin() + 3);
  const Answer answer = answer_of(results, RankedBy::kAmd);
  ASSERT_NE(answer.limit, nullptr);
  EXPECT_EQ(answer.limit->pipeline, "all");
  EXPECT_FALSE(answer.limit_is_host_sync);
}

TEST(Answer, OfASingleCameraTheErrorRanks) {
  Results results = sample();
  for (Row& row : results.rows) row.amd_ms = make_series(std::vector<double>(12, kNan));
  const Answer answer = answer_of(results, RankedBy::kAmd);
  EXPECT_EQ(answer.ranked_by, RankedBy::kAbsoluteError);
  ASSERT_NE(answer.best, nullptr);
  EXPECT_EQ(answer.best->pipeline, "far");  // 10 / value
}

TEST(Answer, ThereIsNoneWithoutAPipelineThatARigCanRun) {
  Results results = sample();
  results.rows.erase(results.rows.begin(), results.rows.begin() + 3);
  EXPECT_EQ(answer_of(results, RankedBy::kAmd).best, nullptr);
  EXPECT_EQ(answer_of({}, RankedBy::kAmd).best, nullptr);
}

TEST(Answer, FewSeedsTellNothingApart) {
  Results results = sample();
  for (Row& row : results.rows) {
    row.amd_ms = make_series({row.amd_ms.values[0], row.amd_ms.values[1]});
  }
  const Answer answer = answer_of(results, RankedBy::kAmd);
  EXPECT_THAT(names_of(answer.equals), testing::ElementsAre("equal", "far"));
  EXPECT_EQ(answer.next, nullptr);
}

}  // namespace
}  // namespace simbench::evaluation
