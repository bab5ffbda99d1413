#include "reports/rigs/prediction_report.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/statistics/statistics.h"
#include "tests/reports/sample_results.h"

namespace simbench::reports {
namespace {

using evaluation::GroundTruth;
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

Results simulated() {
  Results results = sample_results();
  results.rows = {row_of("both", {1, 2, 3}, GroundTruth::kSimulation),
                  row_of("time", {4, 5, 6}, GroundTruth::kSimulation)};
  results.rows[0].host_error_ms = evaluation::make_series({0.1, 0.2, 0.3});
  results.seed_count = 3;
  return results;
}

Results measured(std::vector<double> amd, GroundTruth truth = GroundTruth::kGenlockOrder) {
  Results results = sample_results();
  results.rows = {row_of("both", std::move(amd), truth)};
  results.seed_count = results.rows[0].amd_ms.values.size();
  return results;
}

TEST(Prediction, TheMeasuredMedianIsInsideTheSimulatedBandOrNot) {
  const std::vector<Prediction> rows = predictions(measured({2.5, 2.7}), simulated());
  ASSERT_EQ(rows.size(), 2);  // errors cannot be measured there
  EXPECT_EQ(rows[0].metric, "amd_ms");
  EXPECT_EQ(rows[0].inside, true);  // 2.6 in [1.1, 2.9]
  EXPECT_EQ(rows[1].metric, "rmdv_ms");
  EXPECT_EQ(rows[1].inside, true);
  EXPECT_EQ(predictions(measured({2.95, 2.95}), simulated())[0].inside, false);
  EXPECT_EQ(predictions(measured({1.0, 1.0}), simulated())[0].inside, false);
}

TEST(Prediction, WhereTruthIsKnownErrorsAreComparedToo) {
  Results known = measured({2, 2});
  known.rows[0].host_error_ms = evaluation::make_series({0.2, 0.25});
  const std::vector<Prediction> rows = predictions(known, simulated());
  ASSERT_EQ(rows.size(), 3);
  EXPECT_EQ(rows[2].metric, "host_error_ms");
  EXPECT_EQ(rows[2].inside, true);
}

TEST(Prediction, UnverifiedRowsAreComparedBySets) {
  const Results found = measured({2, 2}, GroundTruth::kNone);
  const std::vector<Prediction> rows = predictions(found, simulated());
  ASSERT_EQ(rows.size(), 1);
  EXPECT_EQ(rows[0].metric, "set_amd_ms");
  EXPECT_FALSE(rows[0].verified);
  EXPECT_EQ(rows[0].inside, true);  // 1 in [0.55, 1.45]
  EXPECT_THAT(plain({.blocks = {prediction_block(found, simulated())}}),
              HasSubstr("AMD of sets (unverified)"));
}

TEST(Prediction, OneRepetitionHasAValueAndNoBand) {
  const std::string text = plain({.blocks = {prediction_block(measured({2}), simulated())}});
  EXPECT_THAT(
      text,
      HasSubstr("both      AMD         2.000         -      2.000  [1.100, 2.900]  inside\n"));
  EXPECT_THAT(text, HasSubstr("One repetition\nhas a value and no band."));
  EXPECT_THAT(plain({.blocks = {prediction_block(measured({2, 2}), simulated())}}),
              Not(HasSubstr("One repetition")));
}

TEST(Prediction, APipelineThatWasNeverCapturedHasItsPrediction) {
  const Results nothing = measured({kNaN, kNaN}, GroundTruth::kNone);
  const std::vector<Prediction> rows = predictions(nothing, simulated());
  ASSERT_EQ(rows.size(), 1);
  EXPECT_EQ(rows[0].metric, "amd_ms");
  EXPECT_FALSE(rows[0].inside.has_value());
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
  EXPECT_EQ(root["prediction"]["seeds"]["count"], 3);
  const auto& row = root["prediction"]["rows"][0];
  EXPECT_EQ(row["pipeline"], "both");
  EXPECT_EQ(row["metric"], "amd_ms");
  EXPECT_EQ(row["measured"]["count"], 1);
  EXPECT_EQ(row["measured"]["median"], 2);
  EXPECT_TRUE(row["measured"]["p05"].is_null());
  EXPECT_DOUBLE_EQ(row["simulated"]["p05"], 1.1);
  EXPECT_EQ(row["inside"], true);
  EXPECT_EQ(row["verified"], true);
}

TEST(Prediction, Markdown) {
  EXPECT_THAT(
      markdown({.blocks = {prediction_block(measured({2.5, 2.7}), simulated())}}),
      HasSubstr("| both | AMD | 2.600 | [2.510, 2.690] | 2.000 | [1.100, 2.900] | inside |"));
}

}  // namespace
}  // namespace simbench::reports
