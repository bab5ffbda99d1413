#include "evaluation/run/leaderboard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

Row leaderboard_row(const std::string& pipeline, std::vector<double> errors, bool offline = false) {
  Row row;
  row.pipeline = pipeline;
  row.offline = offline;
  row.absolute_error_ms = make_series(errors);
  for (double& error : errors) error *= 10;
  row.amd_ms = make_series(errors);
  return row;
}

std::vector<std::string> names(const std::vector<Rank>& ranks) {
  std::vector<std::string> names;
  names.reserve(ranks.size());
  for (const Rank& rank : ranks) names.push_back(rank.row->pipeline);
  return names;
}

TEST(Leaderboard, BoardsAreSortedByErrorOnlineAndOfflineApart) {
  Results results;
  results.rows = {
      leaderboard_row("yoon2021_both", {4, 8}),   leaderboard_row("host.a", {3, 3}),
      leaderboard_row("host.none", {kNan, kNan}), leaderboard_row("host.oracle", {1, 1}),
      leaderboard_row("device.x", {2, 2}, true),  leaderboard_row("host.b", {2, 2})};
  const std::vector<Board> boards = leaderboard(results);
  ASSERT_EQ(boards.size(), 3U);
  EXPECT_EQ(boards[0].name, "");
  EXPECT_EQ(boards[1].name, "host");
  EXPECT_EQ(names(boards[1].online),
            (std::vector<std::string>{"host.oracle", "host.b", "host.a", "host.none"}));
  EXPECT_TRUE(boards[1].offline.empty());
  EXPECT_TRUE(boards[2].online.empty());
  EXPECT_EQ(names(boards[2].offline), std::vector<std::string>{"device.x"});
}

TEST(Leaderboard, RatiosArePairedBySeed) {
  Results results;
  results.rows = {leaderboard_row("yoon2021_both", {4, 8, 16}),
                  leaderboard_row("host.a", {2, 2, 2}),
                  leaderboard_row("host.oracle", {1, 0, 0.5})};
  const std::vector<Board> boards = leaderboard(results);
  const Rank& a = boards[1].online[1];
  ASSERT_EQ(a.row->pipeline, "host.a");
  EXPECT_DOUBLE_EQ(a.to_paper.error.median, 0.25);  // of 1/2, 1/4, 1/8
  EXPECT_DOUBLE_EQ(a.to_oracle.error.values[0], 2);
  EXPECT_TRUE(std::isnan(a.to_oracle.error.values[1]));  // nothing is a multiple of no error
  EXPECT_DOUBLE_EQ(a.to_oracle.amd.median, 3);           // of 2 and 4
}

TEST(Leaderboard, PoliciesOfOneStampAreInOrderOfRecall) {
  Results results;
  results.rows = {leaderboard_row("gather.a", {2, 2}), leaderboard_row("gather.none", {2, 2}),
                  leaderboard_row("gather.b", {2, 2})};
  for (Row& row : results.rows) row.gathering = row.pipeline;
  results.rows[0].recall = 0.5;
  results.rows[1].recall = kNan;
  results.rows[2].recall = 0.9;
  const std::vector<Board> boards = leaderboard(results);
  EXPECT_TRUE(boards[0].of_gathering);
  EXPECT_EQ(names(boards[0].online),
            (std::vector<std::string>{"gather.b", "gather.a", "gather.none"}));
}

TEST(Leaderboard, ABoardWithoutOracleHasNoSuchRatio) {
  Results results;
  results.rows = {leaderboard_row("device.x", {2, 2})};
  const std::vector<Board> boards = leaderboard(results);
  EXPECT_TRUE(std::isnan(boards[0].online[0].to_oracle.error.median));
  EXPECT_TRUE(std::isnan(boards[0].online[0].to_paper.amd.median));
}

}  // namespace
}  // namespace simbench::evaluation
