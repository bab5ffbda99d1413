#include "evaluation/model_gap.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "evaluation/evidence.h"
#include "evaluation/statistics.h"
#include "evaluation/two_sample_ks.h"

namespace simbench::evaluation {
namespace {

using ::testing::IsNan;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTolerance = 1e-12;

TEST(TwoSampleKs, DistanceOfSmallSamples) {
  EXPECT_DOUBLE_EQ(ks_distance({1, 2, 3}, {1, 2, 3}), 0);
  EXPECT_DOUBLE_EQ(ks_distance({1, 2, 3}, {4, 5}), 1);
  EXPECT_DOUBLE_EQ(ks_distance({1, 2, 3}, {2, 3, 4}), 1.0 / 3);
  EXPECT_DOUBLE_EQ(ks_distance({3, 1}, {2}), 0.5);
  EXPECT_DOUBLE_EQ(ks_distance({1, 2, 3, 4}, {2.5}), 0.5);
}

TEST(TwoSampleKs, EqualValuesStepTogether) {
  EXPECT_DOUBLE_EQ(ks_distance({1, 1, 1, 1}, {1}), 0);
  EXPECT_DOUBLE_EQ(ks_distance({1, 1, 2, 2}, {1, 2}), 0);
  EXPECT_DOUBLE_EQ(ks_distance({1, 1, 1, 2}, {1, 2, 2, 2}), 0.5);
}

TEST(TwoSampleKs, WithoutValuesThereIsNoDistance) {
  EXPECT_THAT(ks_distance({}, {1}), IsNan());
  EXPECT_THAT(ks_distance({1}, {kNan}), IsNan());
  EXPECT_DOUBLE_EQ(ks_distance({kNan, 1, kNan, 3}, {2, kNan}), 0.5);
}

// Of the C(n + m, n) orders, two keep the samples apart altogether.
TEST(TwoSampleKs, ProbabilityOfNoOverlap) {
  EXPECT_NEAR(ks_probability(1, 1, 1), 1, kTolerance);
  EXPECT_NEAR(ks_probability(3, 3, 1), 2.0 / 20, kTolerance);
  EXPECT_NEAR(ks_probability(5, 5, 1), 2.0 / 252, kTolerance);
  EXPECT_NEAR(ks_probability(4, 2, 1), 2.0 / 15, kTolerance);
  EXPECT_NEAR(ks_probability(7, 9, 0), 1, kTolerance);
}

// For equal sizes there is a closed form: the reflection principle gives
// P(D >= k / n) = 2 sum_i (-1)^(i + 1) C(2n, n + i k) / C(2n, n).
TEST(TwoSampleKs, ProbabilityFollowsTheClosedForm) {
  const auto log_choose = [](double n, double k) {
    return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
  };
  for (const int n : {2, 5, 10, 20, 60}) {
    for (int k = 1; k <= n; ++k) {
      double expected = 0;
      for (int i = 1; i * k <= n; ++i) {
        expected += (i % 2 == 1 ? 2 : -2) *
                    std::exp(log_choose(2.0 * n, n + i * k) - log_choose(2.0 * n, n));
      }
      const auto size = static_cast<std::size_t>(n);
      EXPECT_NEAR(ks_probability(size, size, static_cast<double>(k) / n), expected, 1e-9)
          << n << " " << k;
    }
  }
}

// The critical values of the tables in textbooks.
TEST(TwoSampleKs, CriticalDistances) {
  EXPECT_THAT(ks_critical_distance(3, 3), IsNan());
  EXPECT_DOUBLE_EQ(ks_critical_distance(4, 4), 1);
  EXPECT_DOUBLE_EQ(ks_critical_distance(5, 5), 1);
  EXPECT_DOUBLE_EQ(ks_critical_distance(10, 10), 0.7);
  EXPECT_DOUBLE_EQ(ks_critical_distance(20, 20), 0.45);
  EXPECT_THAT(ks_critical_distance(0, 5), IsNan());
}

TEST(TwoSampleKs, TheCriticalDistanceIsTheSmallestThatIsUnlikely) {
  for (std::size_t n = 2; n <= 12; ++n) {
    for (std::size_t m = 2; m <= 12; ++m) {
      const double critical = ks_critical_distance(n, m);
      if (std::isnan(critical)) {
        EXPECT_GT(ks_probability(n, m, 1), 0.05);
        continue;
      }
      EXPECT_LE(ks_probability(n, m, critical), 0.05) << n << " " << m;
      const double step = 1.0 / static_cast<double>(n * m);
      EXPECT_GT(ks_probability(n, m, critical - 1.5 * step * static_cast<double>(std::gcd(n, m))),
                0.05)
          << n << " " << m;
    }
  }
}

TEST(TwoSampleKs, LargeSamplesFollowTheAsymptoticLaw) {
  const double just_exact = ks_critical_distance(1000, 1000);
  EXPECT_NEAR(just_exact, 1.3581 * std::sqrt(2.0 / 1000), 0.001);
  EXPECT_NEAR(ks_critical_distance(1001, 1000), just_exact, 0.001);
}

// Samples of one distribution differ in at most 5 of 100 tests, and nearly so many do.
TEST(TwoSampleKs, RejectsAsOftenAsItSays) {
  constexpr unsigned kSeed = 1933;
  std::mt19937 random(kSeed);
  const double critical = ks_critical_distance(20, 30);
  int rejected = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<double> a;
    std::vector<double> b;
    for (int i = 0; i < 20; ++i) a.push_back(static_cast<double>(random()));
    for (int i = 0; i < 30; ++i) b.push_back(static_cast<double>(random()));
    if (ks_distance(a, b) >= critical) ++rejected;
  }
  EXPECT_NEAR(rejected, 4000 * ks_probability(20, 30, critical), 60) << "seed " << kSeed;
}

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

TEST(Evidence, EveryStageRestsOnSomethingAndSaysWhy) {
  EXPECT_EQ(model_evidence().size(), 12);
  for (const StageEvidence& stage : model_evidence()) {
    int count = 0;
    for (const Evidence evidence : kAllEvidence) count += stage.has(evidence) ? 1 : 0;
    EXPECT_GE(count, 1) << stage.stage;
    EXPECT_GT(stage.why.size(), 20) << stage.stage;
  }
}

// The experiment has no cameras: it cannot be evidence for any stage of them.
TEST(Evidence, TheExperimentIsNoEvidenceForCameras) {
  for (const StageEvidence& stage : model_evidence()) {
    const bool of_cameras = stage.stage == "trigger" || stage.stage == "exposure" ||
                            stage.stage == "device clock" || stage.stage == "USB and host stack";
    if (of_cameras) EXPECT_FALSE(stage.has(Evidence::kExperiment)) << stage.stage;
  }
}

}  // namespace
}  // namespace simbench::evaluation
