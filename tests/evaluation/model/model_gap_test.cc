#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "evaluation/model/evidence.h"
#include "evaluation/statistics/statistics.h"

namespace simbench::evaluation {
namespace {

using ::testing::IsNan;

Row row_of(const std::string& pipeline, std::vector<double> amd, std::vector<double> host) {
  Row row;
  row.pipeline = pipeline;
  row.amd_ms = make_series(std::move(amd));
  row.host_error_ms = make_series(std::move(host));
  return row;
}

TEST(ModelGap, ARowPerPipelineAndMetric) {
  Results measured;
  measured.rows = {row_of("both", {1, 2, 3}, {0.01, 0.02, 0.03}), row_of("mine", {1}, {1})};
  Results simulated;
  simulated.rows = {row_of("none", {9}, {9}), row_of("both", {2, 3, 4, 5}, {0.04, 0.05})};
  const std::vector<ModelGapRow> rows = model_gap(measured, simulated);
  ASSERT_EQ(rows.size(), 2);
  EXPECT_EQ(rows[0].metric, "host_error_ms");
  EXPECT_EQ(rows[1].metric, "amd_ms");
  const ModelGapRow& amd = rows[1];
  EXPECT_EQ(amd.pipeline, "both");
  EXPECT_EQ(amd.measured.count, 3);
  EXPECT_EQ(amd.simulated.count, 4);
  EXPECT_DOUBLE_EQ(amd.measured.series.median, 2);
  EXPECT_DOUBLE_EQ(amd.simulated.series.median, 3.5);
  EXPECT_DOUBLE_EQ(amd.measured.quantiles[1], 1.5);
  EXPECT_DOUBLE_EQ(amd.simulated.quantiles[4], 4.85);
  EXPECT_DOUBLE_EQ(amd.median_gap, 0.75);
  EXPECT_EQ(amd.within_20_percent, false);
  EXPECT_DOUBLE_EQ(amd.ks, 0.5);  // at 3: all of one, half of the other
  EXPECT_FALSE(amd.significant());
}

TEST(ModelGap, SmallMediansAreNotJudged) {
  Results measured;
  measured.rows = {row_of("both", {0.06, 0.06}, {0.05, 0.05})};
  Results simulated;
  simulated.rows = {row_of("both", {0.07, 0.07}, {0.05, 0.05})};
  const std::vector<ModelGapRow> rows = model_gap(measured, simulated);
  EXPECT_FALSE(rows[0].within_20_percent.has_value());  // 50 us and no more
  EXPECT_EQ(rows[1].within_20_percent, true);           // 16.7 %
  simulated.rows = {row_of("both", {0.08, 0.08}, {1, 1})};
  EXPECT_EQ(model_gap(measured, simulated)[1].within_20_percent, false);
}

TEST(ModelGap, WhatOnlyOneSideHasIsThereWithoutAVerdict) {
  Results measured;
  measured.rows = {row_of("both", {1, 2}, {kNan, kNan})};
  Results simulated;
  simulated.rows = {row_of("both", {1, 2}, {0.1, 0.2})};
  const std::vector<ModelGapRow> rows = model_gap(measured, simulated);
  ASSERT_EQ(rows.size(), 2);
  EXPECT_EQ(rows[0].measured.count, 0);
  EXPECT_THAT(rows[0].ks, IsNan());
  EXPECT_THAT(rows[0].measured.series.median, IsNan());
  EXPECT_FALSE(rows[0].within_20_percent.has_value());
  EXPECT_FALSE(rows[0].significant());
}

}  // namespace
}  // namespace simbench::evaluation
