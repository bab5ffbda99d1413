#include "algorithms/certificates/steady_readings.h"

#include <gtest/gtest.h>

namespace simbench {
namespace {

HostTime host_ms(std::int64_t ms) { return HostTime(Nanoseconds(ms * 1'000'000)); }
SteadyTime at_ms(std::int64_t ms) { return SteadyTime(Nanoseconds(ms * 1'000'000)); }

double first_ms(const std::optional<SteadyRange>& range) {
  return to_ms(range->first.time_since_epoch());
}
double last_ms(const std::optional<SteadyRange>& range) {
  return to_ms(range->last.time_since_epoch());
}

ClockAdjustment set_at(std::int64_t at, std::int64_t before, std::int64_t after, double ppb = 0) {
  return {.at = at_ms(at), .before = host_ms(before), .after = host_ms(after), .rate_ppb = ppb};
}

TEST(SteadyReadings, NothingWithoutALog) {
  EXPECT_FALSE(SteadyReadings().when(host_ms(1), host_ms(1)));
}

TEST(SteadyReadings, ALineGoesBackAndOn) {
  SteadyReadings readings;
  readings.add(set_at(1000, 5000, 5000));
  EXPECT_NEAR(first_ms(readings.when(host_ms(4000), host_ms(4000))), 0, 1e-5);
  EXPECT_NEAR(last_ms(readings.when(host_ms(9000), host_ms(9001))), 5001, 1e-5);
}

TEST(SteadyReadings, ARateIsTakenOff) {
  SteadyReadings readings;
  readings.add(set_at(0, 0, 0, 1e6));  // 1000 ppm fast
  EXPECT_NEAR(first_ms(readings.when(host_ms(1001), host_ms(1001))), 1000, 1e-5);
}

// Stepped back by 300 ms at 1000 ms: 800 was read before and after.
TEST(SteadyReadings, AStepBackMakesReadingsAmbiguous) {
  SteadyReadings readings;
  readings.add(set_at(0, 0, 0));
  readings.add(set_at(1000, 1000, 700));
  const auto both = readings.when(host_ms(800), host_ms(800));
  EXPECT_NEAR(first_ms(both), 800, 1e-5);
  EXPECT_NEAR(last_ms(both), 1100, 1e-5);
  const auto later = readings.when(host_ms(1200), host_ms(1200));
  EXPECT_NEAR(first_ms(later), 1500, 1e-5);
}

// Stepped on by 300 ms: nothing between was ever read.
TEST(SteadyReadings, AStepOnLeavesAGap) {
  SteadyReadings readings;
  readings.add(set_at(0, 0, 0));
  readings.add(set_at(1000, 1000, 1300));
  EXPECT_FALSE(readings.when(host_ms(1100), host_ms(1200)));
  EXPECT_NEAR(first_ms(readings.when(host_ms(900), host_ms(1400))), 900, 1e-5);
  EXPECT_NEAR(last_ms(readings.when(host_ms(900), host_ms(1400))), 1100, 1e-5);
}

}  // namespace
}  // namespace simbench
