#include "evaluation/scoring/pulse_scores.h"

#include <gtest/gtest.h>

namespace simbench::evaluation {
namespace {

FrameTruth truth_at(double ms) {
  FrameTruth truth;
  truth.exposure_start = TrueTime(from_ms(ms));
  truth.exposure_end = TrueTime(from_ms(ms));
  truth.reference = HostTime(from_ms(ms));
  return truth;
}

TEST(PulseTable, OfTwoFramesOfAPulseTheFirstCountsWithItsTruth) {
  PulseTable table(/*first_pulse=*/7, /*pulses=*/1, /*sources=*/2);
  for (const double ms : {10, 50}) {
    table.store(7, 0, GlobalTime(from_ms(ms)));
    table.store_truth(7, 0, truth_at(ms));
  }
  table.store(7, 1, GlobalTime(from_ms(13)));
  table.store_truth(7, 1, truth_at(12));
  SeedScore score;
  score_pulses(table, {.hosts = 1, .host_of_source = {0, 0}}, score);
  EXPECT_DOUBLE_EQ(score.amd_ms, 3);
  EXPECT_DOUBLE_EQ(score.absolute_error_ms, 0.5);
  EXPECT_DOUBLE_EQ(score.exposure_spread_ms, 2);
}

}  // namespace
}  // namespace simbench::evaluation
