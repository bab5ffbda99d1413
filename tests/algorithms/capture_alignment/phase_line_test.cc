#include "algorithms/capture_alignment/phase_line.h"

#include <gtest/gtest.h>

#include <cmath>

namespace simbench {
namespace {

constexpr Nanoseconds kFramePeriod = std::chrono::milliseconds(30);

// The exposure of frame `counter` of a camera that is 40 us later with every 1000 frames.
HostTime exposed(std::uint32_t counter, Nanoseconds moved = Nanoseconds(0)) {
  return HostTime(std::chrono::hours(1)) + counter * kFramePeriod + from_us(500) +
         Nanoseconds(40 * counter) + moved;
}

TEST(PhaseLine, ForetellsPhaseAndRateTogether) {
  PhaseLine line(kFramePeriod, 100);
  for (std::uint32_t n = 1000; n < 1050; ++n) line.add(n, exposed(n));
  EXPECT_NEAR(line.slope_ns(), 40, 1e-9);
  EXPECT_NEAR(line.error_ns(1100), 500'000 + 40 * 1100, 1e-3);
  // Stamps of whole nanoseconds, as noise of 1 ns, over 50 frames.
  EXPECT_NEAR(line.slope_sigma_ns(), std::sqrt(12 / (50.0 * (2500 - 1))), 1e-6);
}

TEST(PhaseLine, LostFramesDoNoHarm) {
  PhaseLine line(kFramePeriod, 100);
  for (std::uint32_t n = 0; n < 60; n += n % 7 == 0 ? 3 : 1) line.add(n, exposed(n));
  EXPECT_NEAR(line.error_ns(100), 500'000 + 4000, 1e-3);
}

TEST(PhaseLine, KnowsTheMoves) {
  PhaseLine line(kFramePeriod, 100);
  for (std::uint32_t n = 0; n < 20; ++n) line.add(n, exposed(n));
  line.move(25, from_us(-300));
  EXPECT_NEAR(line.error_ns(24), 500'000 + 960, 1e-3);
  EXPECT_NEAR(line.error_ns(25), 200'000 + 1000, 1e-3);
  for (std::uint32_t n = 20; n < 400; ++n) {
    line.add(n, exposed(n, n < 25 ? Nanoseconds(0) : from_us(-300)));
    EXPECT_FALSE(line.is_surprised(10));
  }
  EXPECT_NEAR(line.error_ns(400), 200'000 + 16'000, 1e-3);
}

TEST(PhaseLine, IsSurprisedByALostControlAndBeginsAnew) {
  PhaseLine line(kFramePeriod, 100);
  for (std::uint32_t n = 0; n < 20; ++n) line.add(n, exposed(n));
  line.move(20, from_us(-300));
  for (std::uint32_t n = 20; n < 26; ++n) line.add(n, exposed(n));
  EXPECT_TRUE(line.is_surprised(10'000));
  line.forget();
  EXPECT_EQ(line.frames(), 0U);
  for (std::uint32_t n = 26; n < 40; ++n) line.add(n, exposed(n));
  EXPECT_NEAR(line.error_ns(40), 500'000 + 1600, 1e-3);
  EXPECT_FALSE(line.is_surprised(10'000));
}

TEST(PhaseLine, AMoveByAPeriodShiftsTheGrid) {
  PhaseLine line(kFramePeriod, 100);
  for (std::uint32_t n = 0; n < 20; ++n) line.add(n, exposed(n));
  line.move(20, kFramePeriod - from_us(500));
  line.shift_grid(1);
  line.restart();
  for (std::uint32_t n = 20; n < 40; ++n) line.add(n, exposed(n, kFramePeriod - from_us(500)));
  EXPECT_NEAR(line.error_ns(40), 1600, 1e-3);
}

// Two stamps of which one is 1 us late: alone they would foretell 100 us after 100 frames.
TEST(PhaseLine, ARestartKeepsTheRate) {
  PhaseLine line(kFramePeriod, 100);
  for (std::uint32_t n = 0; n < 50; ++n) line.add(n, exposed(n));
  line.move(50, from_us(200));
  line.restart();
  EXPECT_NEAR(line.slope_ns(), 40, 1e-9);
  line.add(60, exposed(60, from_us(250)));
  line.add(61, exposed(61, from_us(251)));
  EXPECT_NEAR(line.slope_ns(), 40, 0.1);
  EXPECT_NEAR(line.error_ns(160), 750'500 + 40 * 160, 20);
  line.forget();
  EXPECT_EQ(line.slope_ns(), 0);
}

}  // namespace
}  // namespace simbench
