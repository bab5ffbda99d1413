#include "reports/recordings/prediction_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using evaluation::GroundTruth;
using evaluation::Placement;
using evaluation::Results;
using evaluation::Row;
using testing::HasSubstr;
using testing::Not;

Row row_of(const std::string& pipeline, std::vector<double> amd, GroundTruth truth) {
  const std::vector<double> nothing(amd.size(), kNaN);
  Row row;
  row.pipeline = pipeline;
  row.ground_truth = truth;
  row.amd_ms = evaluation::make_series(amd);
  for (double& value : amd) value /= 2;
  row.rmdv_ms = evaluation::make_series(amd);
  row.set_amd_ms = row.rmdv_ms;
  row.host_error_ms = row.absolute_error_ms = evaluation::make_series(nothing);
  return row;
}

// 101 values from 1 to 3 times `middle` / 2.
std::vector<double> even(double middle) {
  std::vector<double> values;
  for (int i = -50; i <= 50; ++i) values.push_back(middle * (1 + i / 100.0));
  return values;
}

Results simulated() {
  Results results = sample_results();
  results.rows = {row_of("both", even(2), GroundTruth::kSimulation),
                  row_of("time", even(5), GroundTruth::kSimulation)};
  results.rows[0].host_error_ms = evaluation::make_series(even(0.2));
  results.seed_count = 101;
  return results;
}

evaluation::Placement place(const Prediction& row) {
  return evaluation::placement_of(row.percentile.value());
}

Results measured(std::vector<double> amd, GroundTruth truth = GroundTruth::kGenlockOrder) {
  Results results = sample_results();
  results.rows = {row_of("both", std::move(amd), truth)};
  results.seed_count = results.rows[0].amd_ms.values.size();
  return results;
}

TEST(Prediction, TheMeasuredMedianIsPlacedByItsPercentile) {
  const std::vector<Prediction> rows = predictions(measured({2.5, 2.7}), simulated());
  ASSERT_EQ(rows.size(), 2);  // errors cannot be measured there
  EXPECT_EQ(rows[0].metric, "amd_ms");
  EXPECT_EQ(place(rows[0]), Placement::kInside);  // 80 of 101 are below
  EXPECT_EQ(rows[1].metric, "rmdv_ms");
  EXPECT_EQ(place(rows[1]), Placement::kInside);
  // Beyond the band of [1.1, 2.9], which the percentile's interval does not show.
  EXPECT_EQ(place(predictions(measured({2.95, 2.95}), simulated())[0]), Placement::kTooFewSeeds);
  for (const double far : {0.9, 3.1}) {
    EXPECT_EQ(place(predictions(measured({far, far}), simulated())[0]), Placement::kOutside) << far;
  }
}

TEST(Prediction, WhereTruthIsKnownErrorsAreComparedToo) {
  Results known = measured({2, 2});
  known.rows[0].host_error_ms = evaluation::make_series({0.2, 0.25});
  const std::vector<Prediction> rows = predictions(known, simulated());
  ASSERT_EQ(rows.size(), 3);
  EXPECT_EQ(rows[2].metric, "host_error_ms");
  EXPECT_EQ(place(rows[2]), Placement::kInside);
}

TEST(Prediction, UnverifiedRowsAreComparedBySets) {
  const Results found = measured({2, 2}, GroundTruth::kNone);
  const std::vector<Prediction> rows = predictions(found, simulated());
  ASSERT_EQ(rows.size(), 1);
  EXPECT_EQ(rows[0].metric, "set_amd_ms");
  EXPECT_FALSE(rows[0].verified);
  EXPECT_EQ(place(rows[0]), Placement::kInside);
  EXPECT_THAT(plain({.blocks = {prediction_block(found, simulated())}}),
              HasSubstr("AMD of sets (unverified)"));
}

TEST(Prediction, OneRepetitionHasAValueAndNoBand) {
  const std::string text = plain({.blocks = {prediction_block(measured({2}), simulated())}});
  EXPECT_THAT(
      text,
      HasSubstr("both      AMD      2.00 ms         -    2.00 ms   [1.10, 2.90] ms  inside\n"));
  EXPECT_THAT(text, HasSubstr("One repetition has a\nvalue and no band."));
  EXPECT_THAT(plain({.blocks = {prediction_block(measured({2, 2}), simulated())}}),
              Not(HasSubstr("One repetition")));
}

TEST(Prediction, APipelineThatWasNeverCapturedHasItsPrediction) {
  const Results nothing = measured({kNaN, kNaN}, GroundTruth::kNone);
  const std::vector<Prediction> rows = predictions(nothing, simulated());
  ASSERT_EQ(rows.size(), 1);
  EXPECT_EQ(rows[0].metric, "amd_ms");
  EXPECT_FALSE(rows[0].percentile.has_value());
  EXPECT_THAT(plain({.blocks = {prediction_block(nothing, simulated())}}),
              Not(HasSubstr("unverified")));
}

TEST(Prediction, OfOnePipelineThatWasNotSimulatedThereIsNone) {
  Results others = simulated();
  others.rows.erase(others.rows.begin());
  EXPECT_TRUE(predictions(measured({2}), others).empty());
}

TEST(Prediction, IsAMemberOfTheResultsJson) {
  const auto root = nlohmann::json::parse(json_with_prediction(measured({2}), simulated()));
  EXPECT_EQ(root["rows"].size(), 1);
  EXPECT_EQ(root["prediction"]["seeds"]["count"], 101);
  const auto& row = root["prediction"]["rows"][0];
  EXPECT_EQ(row["pipeline"], "both");
  EXPECT_EQ(row["metric"], "amd_ms");
  EXPECT_EQ(row["measured"]["count"], 1);
  EXPECT_EQ(row["measured"]["median"], 2);
  EXPECT_TRUE(row["measured"]["p05"].is_null());
  EXPECT_DOUBLE_EQ(row["simulated"]["p05"], 1.1);
  EXPECT_EQ(row["inside"], true);
  EXPECT_EQ(row["verified"], true);
  const auto beyond = nlohmann::json::parse(json_with_prediction(measured({2.95}), simulated()));
  EXPECT_TRUE(beyond["prediction"]["rows"][0]["inside"].is_null());
}

TEST(Prediction, Markdown) {
  EXPECT_THAT(
      markdown({.blocks = {prediction_block(measured({2.5, 2.7}), simulated())}}),
      HasSubstr("| both | AMD | 2.60 ms | [2.51, 2.69] ms | 2.00 ms | [1.10, 2.90] ms | inside |"));
}

}  // namespace
}  // namespace simbench::reports
