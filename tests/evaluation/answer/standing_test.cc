#include "evaluation/answer/standing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace simbench::evaluation {
namespace {

Row stage_row(const std::string& host_sync, const std::string& device_time) {
  Row row;
  row.host_sync = host_sync;
  row.device_time = device_time;
  row.gathering = "yoon2021";
  row.amd_ms = make_series({1, 2, 3});
  row.host_error_ms = make_series({1, 2, 3});
  row.sets = {
      .emitted = 10, .pure = 9, .complete_pulses = 10, .due_pulses = 10, .exposed_pulses = 10};
  return row;
}

RowStanding standing(const Row& row, RankedBy ranked_by = RankedBy::kAmd) {
  return standing_of(row, ranked_by).is;
}

TEST(Standing, FollowsFromTheStages) {
  EXPECT_EQ(standing(stage_row("ntp", "regression_30")), RowStanding::kRanked);
  EXPECT_EQ(standing(stage_row("oracle", "regression_30")), RowStanding::kLimit);
  EXPECT_EQ(standing(stage_row("ntp", "oracle")), RowStanding::kLimit);
  EXPECT_EQ(standing(stage_row("ntp", "sensor_normalised")), RowStanding::kReference);
}

TEST(Standing, OfExposuresTheTriggerIsAReference) {
  Row row = stage_row("ntp", "regression_30");
  row.exposure_spread_p95_ms = make_series({1, 2, 3});
  EXPECT_EQ(standing(row, RankedBy::kExposureSpread), RowStanding::kReference);
  row.capture_alignment = "phase_rate";
  EXPECT_EQ(standing(row, RankedBy::kExposureSpread), RowStanding::kRanked);
}

struct FailureCase {
  const char* what;
  void (*change)(Row&);
  const char* reason;
};

class FailedStanding : public testing::TestWithParam<FailureCase> {};

TEST_P(FailedStanding, SaysWhy) {
  Row row = stage_row("ntp", "regression_30");
  GetParam().change(row);
  const ReasonedStanding found = standing_of(row, RankedBy::kAmd);
  EXPECT_EQ(found.is, RowStanding::kFailed);
  EXPECT_EQ(found.reason, GetParam().reason);
  EXPECT_STREQ(standing_id(found.is), "failed");
}

INSTANTIATE_TEST_SUITE_P(
    All, FailedStanding,
    testing::Values(FailureCase{"NotSynchronised", [](Row& row) { row.unsynchronised_hosts = 3; },
                                "hosts were not synchronised (3 over all seeds)"},
                    FailureCase{"NoPulse",
                                [](Row& row) {
                                  row.sets = {};
                                  row.amd_ms = make_series({kNan, kNan});
                                },
                                "no pulse was delivered by all cameras"},
                    FailureCase{"NoSet", [](Row& row) { row.sets.emitted = row.sets.pure = 0; },
                                "no complete set was gathered"},
                    FailureCase{"MixedSets", [](Row& row) { row.sets.pure = 0; },
                                "no gathered set is of one pulse"},
                    FailureCase{"NoValue",
                                [](Row& row) {
                                  row.amd_ms = make_series({kNan, kNan});
                                },
                                "it has no AMD"},
                    FailureCase{"NotRecorded",
                                [](Row& row) {
                                  row.amd_ms = make_series({kNan, kNan});
                                  row.notes = {"repetition 1: no camera"};
                                },
                                "repetition 1: no camera"}),
    [](const auto& each) { return std::string(each.param.what); });

// Clocks that nobody sets keep their place among clocks, though nothing can be gathered by them.
TEST(Standing, SetsHaveNoPartInTheErrorOfTheClocks) {
  Row row = stage_row("free_running", "regression_30");
  row.sets.pure = 0;
  EXPECT_EQ(standing(row), RowStanding::kFailed);
  EXPECT_EQ(standing(row, RankedBy::kHostError), RowStanding::kRanked);
}

TEST(Standing, WithoutTruthNobodyKnowsWhichSetsMix) {
  Row row = stage_row("ntp", "regression_30");
  row.ground_truth = GroundTruth::kNone;
  row.sets = {.emitted = 5};
  EXPECT_EQ(standing(row), RowStanding::kRanked);
}

TEST(RankedBy, HasItsMetricAndName) {
  EXPECT_EQ(ranked_by(scenarios::TableKind::kLeaderboard), RankedBy::kAmd);
  EXPECT_EQ(ranked_by(scenarios::TableKind::kAlignment), RankedBy::kExposureSpread);
  for (const std::string& id : ranking_metrics()) {
    const auto ranked = ranked_by_named(id);
    ASSERT_TRUE(ranked) << id;
    EXPECT_EQ(ranked_metric(*ranked).id, id);
  }
  EXPECT_FALSE(ranked_by_named("recall"));
  EXPECT_FALSE(ranked_by_named("clock_spread_ms")) << "not of captures";
}

}  // namespace
}  // namespace simbench::evaluation
