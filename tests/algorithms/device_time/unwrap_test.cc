#include "algorithms/device_time/unwrap.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cstdint>
#include <utility>
#include <vector>

namespace simbench {
namespace {

constexpr std::int64_t kWrapUs = std::int64_t{1} << 32;

std::int64_t unwrapped_us(DeviceStampUnwrapper& unwrapper, std::uint32_t reading) {
  return unwrapper.unwrap(DeviceStamp{reading}).time_since_epoch().count();
}

TEST(DeviceStampUnwrapper, FirstStampAnchors) {
  DeviceStampUnwrapper unwrapper;
  EXPECT_EQ(unwrapped_us(unwrapper, 4'000'000'000U), 4'000'000'000);
}

TEST(DeviceStampUnwrapper, CountsManyWraps) {
  DeviceStampUnwrapper unwrapper;
  // 40 hours of frames two minutes apart: 33 wraps.
  for (std::int64_t us = 123; us < 40LL * 3'600'000'000; us += 120'000'000) {
    ASSERT_EQ(unwrapped_us(unwrapper, static_cast<std::uint32_t>(us)), us);
  }
}

TEST(DeviceStampUnwrapper, GoesBackOverAWrapWithALateFrame) {
  DeviceStampUnwrapper unwrapper;
  EXPECT_EQ(unwrapped_us(unwrapper, 4'294'900'000U), 4'294'900'000);
  EXPECT_EQ(unwrapped_us(unwrapper, 5U), kWrapUs + 5);
  EXPECT_EQ(unwrapped_us(unwrapper, 4'294'950'000U), 4'294'950'000);  // overtaken before the wrap
  EXPECT_EQ(unwrapped_us(unwrapper, 33'000U), kWrapUs + 33'000);
  EXPECT_EQ(unwrapped_us(unwrapper, 20'000U), kWrapUs + 20'000);  // overtaken after it: no wrap
}

TEST(DeviceStampUnwrapper, GoesBelowZeroIfTheFirstStampWasDeliveredEarly) {
  DeviceStampUnwrapper unwrapper;
  EXPECT_EQ(unwrapped_us(unwrapper, 10U), 10);
  EXPECT_EQ(unwrapped_us(unwrapper, 4'294'967'290U), -6);
  EXPECT_EQ(unwrapped_us(unwrapper, 20U), 20);
}

TEST(DeviceStampUnwrapper, HalfTheRangeIsTheLimit) {
  const std::int64_t half = kWrapUs / 2;
  const std::vector<std::pair<std::uint32_t, std::int64_t>> cases = {
      {static_cast<std::uint32_t>(half - 1), half - 1},
      {static_cast<std::uint32_t>(half), -half},  // as near on either side: earlier
      {static_cast<std::uint32_t>(half + 1), -half + 1},
  };
  for (const auto& [reading, expected] : cases) {
    DeviceStampUnwrapper unwrapper;
    unwrapped_us(unwrapper, 0);
    EXPECT_EQ(unwrapped_us(unwrapper, reading), expected);
  }
}

// The 128 s cycle clock of IEEE 1394 cameras, in its ticks.
constexpr std::int64_t kCycleClock = 128LL * 8000 * 3072;

TEST(CounterUnwrapper, UnwrapsTheCycleClockWithReordering) {
  constexpr std::uint32_t kSeed = 7;
  boost::random::mt19937 random(kSeed);
  boost::random::uniform_int_distribution<std::int64_t> step(-kCycleClock / 2, kCycleClock / 2 - 1);
  CounterUnwrapper<kCycleClock> unwrapper;
  std::int64_t expected = 5;
  ASSERT_EQ(unwrapper.unwrap(expected), expected);
  for (int i = 0; i < 10'000; ++i) {
    expected += step(random);
    const std::int64_t reading = ((expected % kCycleClock) + kCycleClock) % kCycleClock;
    ASSERT_EQ(unwrapper.unwrap(reading), expected) << "step " << i << ", seed " << kSeed;
  }
}

TEST(CounterUnwrapper, OddModulus) {
  CounterUnwrapper<7> unwrapper;
  const std::array<std::int64_t, 8> readings = {3, 6, 2, 5, 1, 4, 1, 5};
  const std::array<std::int64_t, 8> expected = {3, 6, 9, 12, 15, 18, 15, 12};
  for (std::size_t i = 0; i < readings.size(); ++i) {
    EXPECT_EQ(unwrapper.unwrap(readings[i]), expected[i]) << "reading " << i;
  }
}

}  // namespace
}  // namespace simbench
