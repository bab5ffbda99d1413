#include "reconstruction/error_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/engine/random.h"

namespace simbench::reconstruction {
namespace {

TEST(ErrorStatistics, OfNothingIsNothing) {
  const ErrorSummary summary = ErrorStatistics().summary();
  EXPECT_EQ(summary.count, 0);
  EXPECT_TRUE(std::isnan(summary.mean_cm));
  EXPECT_TRUE(std::isnan(summary.p95_cm));
}

TEST(ErrorStatistics, OfAFewDistancesByHand) {
  ErrorStatistics errors;
  for (const double metres : {0.01, 0.02, 0.03, 0.10}) errors.add(metres);
  const ErrorSummary summary = errors.summary();
  EXPECT_EQ(summary.count, 4);
  EXPECT_DOUBLE_EQ(summary.mean_cm, 4.0);
  // Deviations -3, -2, -1, 6 cm: their mean square is 12.5.
  EXPECT_NEAR(summary.std_cm, std::sqrt(12.5), 1e-9);
  EXPECT_NEAR(summary.median_cm, 2.0, 0.011);
}

TEST(ErrorStatistics, QuantilesOfAnEvenSpreadAreThatSpread) {
  ErrorStatistics errors;
  for (int i = 0; i <= 10'000; ++i) errors.add(i * 1e-4);  // 0 to 1 m
  EXPECT_NEAR(errors.summary().median_cm, 50.0, 0.02);
  EXPECT_NEAR(errors.summary().p95_cm, 95.0, 0.02);
}

TEST(ErrorStatistics, FarDistancesKeepTheirMean) {
  ErrorStatistics errors;
  errors.add(30.0);
  EXPECT_DOUBLE_EQ(errors.summary().mean_cm, 3000.0);
  EXPECT_NEAR(errors.summary().median_cm, 1000.0, 0.02);  // as the header says
}

TEST(ErrorStatistics, MergedPartsAreTheWhole) {
  ErrorStatistics whole;
  ErrorStatistics first;
  ErrorStatistics second;
  sim::RandomStream random(7, "distances");
  for (int i = 0; i < 1000; ++i) {
    const double distance = random.exponential(0.02);
    whole.add(distance);
    (i % 3 == 0 ? first : second).add(distance);
  }
  first.merge(second);
  EXPECT_EQ(first.summary().count, 1000);
  EXPECT_NEAR(first.summary().mean_cm, whole.summary().mean_cm, 1e-9);
  EXPECT_NEAR(first.summary().std_cm, whole.summary().std_cm, 1e-9);
  EXPECT_DOUBLE_EQ(first.summary().median_cm, whole.summary().median_cm);
  EXPECT_DOUBLE_EQ(first.summary().p95_cm, whole.summary().p95_cm);
}

evaluation::ExposureSet set_of(double first_s, double second_s) {
  evaluation::ExposureSet set;
  set.cameras = {evaluation::SetExposure{.mid_exposure_s = first_s},
                 evaluation::SetExposure{.mid_exposure_s = second_s}, std::nullopt};
  return set;
}

TEST(SeedTally, AddsUpWhatTheSetsHad) {
  ErrorStatistics two_cm;
  two_cm.add(0.02);
  ErrorStatistics four_cm;
  four_cm.add(0.04);
  SeedTally tally;
  tally.add(set_of(1.0, 1.1), true, two_cm);
  tally.add(set_of(2.0, 2.3), true, four_cm);
  tally.add(set_of(3.0, 3.2), false, {});
  const SeedReprojection seed = tally.finish(7, true);
  EXPECT_EQ(seed.seed, 7U);
  EXPECT_TRUE(seed.gathered);
  EXPECT_EQ(seed.sets, 2);
  EXPECT_EQ(seed.failed_sets, 1);
  EXPECT_EQ(seed.missing_frames, 3);
  EXPECT_NEAR(seed.desync_ms, 200, 1e-9);
  EXPECT_NEAR(seed.errors.mean_cm, 3, 1e-9);
  EXPECT_EQ(seed.errors.count, 2);
}

TEST(SeedTally, OfNoSetHasNoErrors) {
  const SeedReprojection seed = SeedTally().finish(1, false);
  EXPECT_EQ(seed.sets, 0);
  EXPECT_TRUE(std::isnan(seed.errors.mean_cm));
  EXPECT_TRUE(std::isnan(seed.desync_ms));
}

}  // namespace
}  // namespace simbench::reconstruction
