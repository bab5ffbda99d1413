#include "evaluation/scoring/claims.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace simbench::evaluation {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Optional;

// Two seeds of every pipeline that a claim speaks of, in which all claims hold.
std::vector<Row> good_rows() {
  const std::map<std::string, double> amd_ms = {
      {"ntp_last_set", 500}, {"yoon2021_time", 4}, {"yoon2021_network", 3}, {"yoon2021_both", 2}};
  std::vector<Row> rows;
  for (const auto& [pipeline, amd] : amd_ms) {
    Row row;
    row.pipeline = pipeline;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      SeedScore score;
      score.seed = seed;
      score.amd_ms = amd;
      score.offline_amd_ms = amd * 1.05;
      score.spread_in_host_ms = 0.1;
      score.spread_between_hosts_ms = 1;
      score.trend_ms = -0.05 * amd;
      score.share_below_half_period = 1;
      score.sets.complete_pulses = 480;
      row.seeds.push_back(score);
    }
    rows.push_back(row);
  }
  return rows;
}

SeedScore& first_seed(std::vector<Row>& rows, const std::string& pipeline) {
  return std::find_if(rows.begin(), rows.end(),
                      [&](const Row& row) { return row.pipeline == pipeline; })
      ->seeds[0];
}

Claim claim(const std::vector<Row>& rows, const std::string& id, double rate_hz = 45) {
  for (const Claim& checked : check_claims(rows, rate_hz)) {
    if (checked.id == id) return checked;
  }
  ADD_FAILURE() << "no claim " << id;
  return {};
}

TEST(ClaimsTest, SaysOfHowManySeedsItsFractionIs) {
  std::vector<Row> rows = good_rows();
  EXPECT_EQ(claim(rows, "C1").decided_seeds, 2U);
  first_seed(rows, "yoon2021_both").amd_ms = kNan;
  EXPECT_EQ(claim(rows, "C1").decided_seeds, 1U);
  EXPECT_THAT(claim(rows, "C1").holds_fraction, Optional(1.0));
}

TEST(ClaimsTest, AllTenInOrderWithTheirText) {
  const std::vector<Claim> claims = check_claims(good_rows(), 45);
  ASSERT_EQ(claims.size(), 10U);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    EXPECT_EQ(claims[i].id, fmt::format("C{}", i + 1));
    EXPECT_FALSE(claims[i].text.empty());
    // Either a fraction or what is missing.
    EXPECT_NE(claims[i].holds_fraction.has_value(), !claims[i].needs.empty()) << claims[i].id;
  }
}

TEST(ClaimsTest, HoldInEverySeed) {
  for (const char* id : {"C1", "C3", "C5", "C6", "C7", "C8", "C9", "C10"}) {
    EXPECT_THAT(claim(good_rows(), id).holds_fraction, Optional(1.0)) << id;
  }
}

struct Counterexample {
  const char* id;
  const char* pipeline;
  double SeedScore::*score;
  double value;
};

TEST(ClaimsTest, EachFailsInASeedJustPastItsThreshold) {
  const std::vector<Counterexample> counterexamples = {
      {"C1", "ntp_last_set", &SeedScore::amd_ms, 20},
      {"C1", "yoon2021_both", &SeedScore::amd_ms, 100},
      {"C3", "yoon2021_both", &SeedScore::amd_ms, 3},
      {"C3", "yoon2021_network", &SeedScore::amd_ms, 4},
      {"C5", "yoon2021_both", &SeedScore::spread_in_host_ms, 0.2},
      {"C6", "yoon2021_both", &SeedScore::trend_ms, -0.2},
      {"C6", "yoon2021_both", &SeedScore::trend_ms, 0.2},
      {"C7", "yoon2021_both", &SeedScore::offline_amd_ms, 1.79},
      {"C7", "yoon2021_both", &SeedScore::offline_amd_ms, 2.21},
      {"C8", "yoon2021_both", &SeedScore::share_below_half_period, 0.989},
      {"C8", "yoon2021_network", &SeedScore::share_below_half_period, 0.989},
      {"C10", "yoon2021_both", &SeedScore::amd_ms, 3},
      {"C10", "yoon2021_time", &SeedScore::amd_ms, 2}};
  for (const Counterexample& example : counterexamples) {
    std::vector<Row> rows = good_rows();
    first_seed(rows, example.pipeline).*example.score = example.value;
    EXPECT_THAT(claim(rows, example.id).holds_fraction, Optional(0.5))
        << example.id << " with " << example.value;
  }
}

TEST(ClaimsTest, TenNeedsNoOrderOfNetworkAndTime) {
  std::vector<Row> rows = good_rows();
  first_seed(rows, "yoon2021_network").amd_ms = 5;
  EXPECT_THAT(claim(rows, "C10").holds_fraction, Optional(1.0));
  EXPECT_THAT(claim(rows, "C3").holds_fraction, Optional(0.5));
}

TEST(ClaimsTest, NineFailsWithASingleSet) {
  std::vector<Row> rows = good_rows();
  first_seed(rows, "ntp_last_set").sets.emitted = 1;
  EXPECT_THAT(claim(rows, "C9").holds_fraction, Optional(0.5));
}

TEST(ClaimsTest, TheOrderIsClaimedPerRate) {
  EXPECT_THAT(claim(good_rows(), "C2", 15.0075).holds_fraction, Optional(1.0));
  EXPECT_EQ(claim(good_rows(), "C3", 15).holds_fraction, std::nullopt);
  EXPECT_THAT(claim(good_rows(), "C3", 15).needs, HasSubstr("45 fps"));
  EXPECT_EQ(claim(good_rows(), "C2", 30).holds_fraction, std::nullopt);
}

TEST(ClaimsTest, FourNeedsTwoScenarios) {
  EXPECT_EQ(claim(good_rows(), "C4").holds_fraction, std::nullopt);
  EXPECT_THAT(claim(good_rows(), "C4").needs, HasSubstr("scenarios"));
}

TEST(ClaimsTest, SayWhichPipelinesWereNotRun) {
  std::vector<Row> rows = good_rows();
  std::erase_if(rows, [](const Row& row) {
    return row.pipeline == "yoon2021_time" || row.pipeline == "ntp_last_set";
  });
  EXPECT_EQ(claim(rows, "C1").holds_fraction, std::nullopt);
  EXPECT_EQ(claim(rows, "C1").needs, "the pipelines ntp_last_set, yoon2021_time");
  EXPECT_EQ(claim(rows, "C9").needs, "the pipeline ntp_last_set");
  EXPECT_THAT(claim(rows, "C5").needs, IsEmpty());
}

TEST(ClaimsTest, SeedsThatCannotTellAreLeftOut) {
  std::vector<Row> rows = good_rows();
  first_seed(rows, "yoon2021_both").amd_ms = kNan;
  EXPECT_THAT(claim(rows, "C10").holds_fraction, Optional(1.0));
  for (Row& row : rows) {
    for (SeedScore& seed : row.seeds) seed.spread_between_hosts_ms = kNan;
  }
  EXPECT_EQ(claim(rows, "C5").holds_fraction, std::nullopt);
  EXPECT_THAT(claim(rows, "C5").needs, HasSubstr("two hosts"));
}

TEST(ClaimsTest, OfNoRowsNeedPipelines) {
  EXPECT_EQ(claim({}, "C6").needs, "the pipeline yoon2021_both");
}

}  // namespace
}  // namespace simbench::evaluation
