#include "evaluation/scoring/claims.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace simbench::evaluation {
namespace {

using ::testing::ElementsAre;
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
      score.t_l_ms = 3;
      score.t_t_ms = 2.5;
      score.get_time_ms = 0.5;
      score.set_time_ms = 4.5;
      score.message_time_ms = 2.75;
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

TEST(ClaimsTest, AreInOrderWithTheirText) {
  std::vector<std::string> ids;
  for (const Claim& checked : check_claims(good_rows(), 45)) {
    ids.push_back(checked.id);
    EXPECT_FALSE(checked.text.empty());
    // Either a fraction or what is missing.
    EXPECT_NE(checked.holds_fraction.has_value(), !checked.needs.empty()) << checked.id;
  }
  EXPECT_THAT(ids, ElementsAre("C1", "C2", "C3", "C4", "C5", "C6", "C7", "C8", "C9", "C10", "C11",
                               "C11b", "C12"));
}

TEST(ClaimsTest, HoldInEverySeed) {
  for (const char* id : {"C1", "C3", "C5", "C6", "C7", "C8", "C9", "C10", "C11", "C11b", "C12"}) {
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
      {"C10", "yoon2021_time", &SeedScore::amd_ms, 2},
      {"C11", "yoon2021_both", &SeedScore::t_l_ms, 2.5},
      {"C11", "yoon2021_both", &SeedScore::t_t_ms, 3},
      {"C11b", "yoon2021_both", &SeedScore::message_time_ms, 2.5},
      {"C11b", "yoon2021_both", &SeedScore::set_time_ms, 5},
      // At 45 fps frames are 22.2 ms apart.
      {"C12", "yoon2021_network", &SeedScore::amd_ms, 22.3},
      {"C12", "ntp_last_set", &SeedScore::amd_ms, 22.2}};
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

TEST(ClaimsTest, FourNeedsBothRates) {
  EXPECT_EQ(claim(good_rows(), "C4").holds_fraction, std::nullopt);
  EXPECT_THAT(claim(good_rows(), "C4").needs, HasSubstr("simbench paper"));
}

TEST(ClaimsTest, TheIntervalBetweenFramesIsThatOfTheRate) {
  std::vector<Row> rows = good_rows();
  first_seed(rows, "yoon2021_time").amd_ms = 30;
  EXPECT_THAT(claim(rows, "C12", 45).holds_fraction, Optional(0.5));
  EXPECT_THAT(claim(rows, "C12", 15).holds_fraction, Optional(1.0));
}

// The claim of these rows at 15 and at 45 fps.
Claim across(const std::string& id, const std::vector<Row>& slow, const std::vector<Row>& fast) {
  for (const Claim& checked : check_claims_across({slow, 15}, {fast, 45})) {
    if (checked.id == id) return checked;
  }
  ADD_FAILURE() << "no claim " << id;
  return {};
}

std::vector<Row> slow_rows() {
  std::vector<Row> rows = good_rows();
  for (Row& row : rows) {
    for (SeedScore& seed : row.seeds) seed.amd_ms *= 2;
  }
  return rows;
}

TEST(ClaimsAcrossRates, FourIsThatAllThreeAreLowerInTheSameSeed) {
  EXPECT_THAT(across("C4", slow_rows(), good_rows()).holds_fraction, Optional(1.0));
  for (const char* pipeline : {"yoon2021_time", "yoon2021_network", "yoon2021_both"}) {
    std::vector<Row> slow = slow_rows();
    std::vector<Row> fast = good_rows();
    first_seed(slow, pipeline).amd_ms = first_seed(fast, pipeline).amd_ms;
    EXPECT_THAT(across("C4", slow, fast).holds_fraction, Optional(0.5)) << pipeline;
    first_seed(slow, pipeline).amd_ms = kNan;
    EXPECT_THAT(across("C4", slow, fast).holds_fraction, Optional(1.0)) << pipeline;
    EXPECT_EQ(across("C4", slow, fast).decided_seeds, 1U);
  }
}

TEST(ClaimsAcrossRates, TheOrderAtBothRatesIsThatOfTheSameSeed) {
  std::vector<Row> slow = slow_rows();
  std::vector<Row> fast = good_rows();
  EXPECT_THAT(across("C2 and C3", slow, fast).holds_fraction, Optional(1.0));
  first_seed(slow, "yoon2021_both").amd_ms = 7;
  EXPECT_THAT(across("C2 and C3", slow, fast).holds_fraction, Optional(0.5));
  fast.back().seeds[1].amd_ms = 0.5;  // the other seed: time below both
  EXPECT_THAT(across("C2 and C3", slow, fast).holds_fraction, Optional(0.0));
}

TEST(ClaimsAcrossRates, SayWhatTheyNeed) {
  EXPECT_EQ(across("C4", good_rows(), {}).needs,
            "the pipelines yoon2021_both, yoon2021_network, yoon2021_time");
  const std::vector<Row> rows = good_rows();
  EXPECT_EQ(check_claims_across({rows, 45}, {rows, 15})[0].needs, "a scenario at 15 fps");
  std::vector<Row> fewer = good_rows();
  for (Row& row : fewer) row.seeds.pop_back();
  EXPECT_EQ(across("C4", rows, fewer).needs, "the same seeds at both rates");
}

// Rows with the printed values of Tables 2 and 3; their seeds say the contrary.
std::vector<Row> published_rows(double none, double time, double network, double both) {
  std::vector<Row> rows = good_rows();
  const std::map<std::string, double> printed = {{"ntp_last_set", none},
                                                 {"yoon2021_time", time},
                                                 {"yoon2021_network", network},
                                                 {"yoon2021_both", both}};
  for (Row& row : rows) {
    row.published.emplace().amd_ms = printed.at(row.pipeline);
    for (SeedScore& seed : row.seeds) seed.amd_ms = 1;
  }
  return rows;
}

TEST(PrintedClaims, AreThoseOfThePrintedValuesAlone) {
  const std::vector<Row> slow = published_rows(547.5033, 15.3963, 11.1648, 5.8539);
  const std::vector<Row> fast = published_rows(538.059, 4.2783, 3.9161, 2.438);
  for (const Claim& printed : check_printed_claims({fast, 45})) {
    const bool is_of_amd =
        printed.id == "C1" || printed.id == "C3" || printed.id == "C10" || printed.id == "C12";
    EXPECT_EQ(printed.holds_fraction.has_value(), is_of_amd) << printed.id;
    if (!is_of_amd) continue;
    EXPECT_THAT(printed.holds_fraction, Optional(1.0)) << printed.id;
  }
  for (const Claim& printed : check_printed_claims_across({slow, 15}, {fast, 45})) {
    EXPECT_THAT(printed.holds_fraction, Optional(1.0)) << printed.id;
  }
  const std::vector<Row> worse = published_rows(538.059, 15.3963, 3.9161, 2.438);
  EXPECT_THAT(check_printed_claims_across({slow, 15}, {worse, 45})[0].holds_fraction,
              Optional(0.0));
}

TEST(HeldPercent, HasTheBinomialIntervalOfTheDecidingSeeds) {
  const Percentile held = held_percent(
      {.id = "C1", .text = "", .holds_fraction = 0.75, .needs = "", .decided_seeds = 4});
  EXPECT_DOUBLE_EQ(held.percent, 75);
  EXPECT_DOUBLE_EQ(held.low, 100 * binomial_interval(3, 4).low);
  EXPECT_DOUBLE_EQ(held.high, 100 * binomial_interval(3, 4).high);
  EXPECT_TRUE(std::isnan(held_percent({}).percent));
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

TEST(ClaimsTest, DelaysOfSessionsNeedNoGroundTruth) {
  std::vector<Row> rows = good_rows();
  for (Row& row : rows) row.ground_truth = GroundTruth::kNone;
  EXPECT_EQ(claim(rows, "C10").holds_fraction, std::nullopt);
  EXPECT_THAT(claim(rows, "C11").holds_fraction, Optional(1.0));
  EXPECT_THAT(claim(rows, "C11b").holds_fraction, Optional(1.0));
}

TEST(ClaimsTest, ARecordingWithoutDelaysDecidesNothingAboutThem) {
  std::vector<Row> rows = good_rows();
  for (Row& row : rows) {
    for (SeedScore& seed : row.seeds) seed.t_l_ms = seed.message_time_ms = kNan;
  }
  for (const char* id : {"C11", "C11b"}) {
    EXPECT_EQ(claim(rows, id).holds_fraction, std::nullopt);
    EXPECT_EQ(claim(rows, id).needs, "a recording with the delays of the sessions");
  }
}

TEST(ClaimsTest, OfNoRowsNeedPipelines) {
  EXPECT_EQ(claim({}, "C6").needs, "the pipeline yoon2021_both");
}

}  // namespace
}  // namespace simbench::evaluation
