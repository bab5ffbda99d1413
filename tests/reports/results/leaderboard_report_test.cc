#include "reports/results/leaderboard_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/results/results_document.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

evaluation::Results boards() {
  evaluation::Results results = sample_results();
  evaluation::Row row = results.rows.front();
  row.pipeline = "host.mine";
  row.host_sync = "mine";
  row.absolute_error_ms = series(14, 15);
  row.host_error_ms = series(0.5, 0.75);
  results.rows.push_back(row);
  row.pipeline = "host.oracle";
  row.host_sync = "oracle";
  row.absolute_error_ms = series(7, 7.5);
  row.host_error_ms = series(0, 0);
  results.rows.push_back(row);
  return results;
}

TEST(LeaderboardReport, SaysWhatABoardVariesAndTheRatios) {
  const std::string text = plain(leaderboard_document(boards(), "Nominal."));
  EXPECT_THAT(text, HasSubstr("Nominal."));
  EXPECT_THAT(text, HasSubstr("host: each host_sync + regression_30 + yoon2021"));
  EXPECT_LT(text.find("\noracle  "), text.find("\nmine  "));
  const std::size_t mine = text.find("\nmine  ");
  const std::string line = text.substr(mine + 1, text.find('\n', mine + 1) - mine - 1);
  EXPECT_THAT(line, HasSubstr(" 2.00 "));  // to the oracle
  EXPECT_THAT(line, HasSubstr("0.500"));   // to the paper's
  EXPECT_THAT(text, Not(HasSubstr("Floor")));
}

TEST(LeaderboardReport, SteeredExposuresHaveAStageAndABlock) {
  evaluation::Results results = boards();
  EXPECT_THAT(plain(leaderboard_document(results, "")), Not(HasSubstr("Alignment of the")));
  for (evaluation::Row& row : results.rows) set_steered(row);
  EXPECT_THAT(plain(leaderboard_document(results, "")),
              AllOf(HasSubstr("host: each host_sync + nudge + regression_30 + yoon2021"),
                    HasSubstr("Alignment of the exposures"), HasSubstr("5.00 ppm"),
                    HasSubstr("wrong locks: cameras reported as")));
  results.rows.back().capture_alignment = "other";
  EXPECT_THAT(plain(leaderboard_document(results, "")),
              HasSubstr("each host_sync + each capture_alignment + regression_30"));
}

TEST(LeaderboardReport, CountsItsSeeds) {
  evaluation::Results results = boards();
  EXPECT_THAT(leaderboard_document(results, "").title, HasSubstr("2 seeds (1-2)"));
  results.seed_count = 1;
  EXPECT_THAT(leaderboard_document(results, "").title, HasSubstr("1 seed (1)"));
}

TEST(LeaderboardReport, SaysWhoseHostSynchronisationFailedAndWhy) {
  EXPECT_THAT(plain(leaderboard_document(boards(), "")),
              HasSubstr("host.mine: host synchronisation failed once over all seeds. Seed 2: "
                        "timeout."));
}

TEST(LeaderboardReport, PrintsTheFloorOfUnequalLinks) {
  evaluation::Results results = boards();
  results.asymmetry_floor = evaluation::asymmetry_floor(0.01, 6);
  EXPECT_THAT(markdown(leaderboard_document(results, "")), HasSubstr("Floor: unequal links"));
  EXPECT_THAT(asymmetry_line(results), HasSubstr("AMD of 11.7 us"));
}

TEST(LeaderboardReport, JsonHasRowsAndBoards) {
  const auto root = nlohmann::json::parse(leaderboard_json(boards(), results_answer(boards())));
  EXPECT_EQ(root["rows"].size(), 4U);
  ASSERT_EQ(root["leaderboard"].size(), 2U);
  const auto& mine = root["leaderboard"][1]["online"][1];
  EXPECT_EQ(mine["pipeline"], "host.mine");
  EXPECT_DOUBLE_EQ(mine["error_to_oracle"]["median"].get<double>(), 2);
  EXPECT_TRUE(root["leaderboard"][0]["online"][0]["error_to_oracle"]["median"].is_null());
}

}  // namespace
}  // namespace simbench::reports
