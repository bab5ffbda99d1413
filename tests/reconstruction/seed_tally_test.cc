#include "reconstruction/seed_tally.h"

#include <gtest/gtest.h>

#include <cmath>

namespace simbench::reconstruction {
namespace {

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
