#include "algorithms/device_time/clock_map.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

constexpr std::int64_t kHostNs = 1'700'000'000'000'000'000;

ClockAdjustment adjustment(std::int64_t at_ns, std::int64_t before_ns, std::int64_t after_ns,
                           double rate_ppb) {
  return {.host = 0,
          .at = SteadyTime(Nanoseconds(at_ns)),
          .before = HostTime(Nanoseconds(before_ns)),
          .after = HostTime(Nanoseconds(after_ns)),
          .rate_ppb = rate_ppb};
}

std::int64_t mapped(const ClockMap& map, std::int64_t steady_ns) {
  return nanoseconds_of(map.to_system(SteadyTime(Nanoseconds(steady_ns))).value());
}

TEST(ClockMap, IsEmptyAtFirst) { EXPECT_FALSE(ClockMap().to_system(SteadyTime{}).has_value()); }

TEST(ClockMap, FollowsOffsetAndRate) {
  ClockMap map;
  map.add(adjustment(5 * kSecondNs, kHostNs, kHostNs, 100'000));
  EXPECT_EQ(mapped(map, 5 * kSecondNs), kHostNs);
  EXPECT_EQ(mapped(map, 15 * kSecondNs), kHostNs + 10 * kSecondNs + 1'000'000);
  EXPECT_EQ(mapped(map, 4 * kSecondNs), kHostNs - kSecondNs - 100'000) << "before the log";
}

TEST(ClockMap, EachInstantHasItsOwnSegment) {
  ClockMap map;
  map.add(adjustment(0, kHostNs, kHostNs, 0));
  map.add(adjustment(10 * kSecondNs, kHostNs + 10 * kSecondNs, kHostNs + 12 * kSecondNs, 0));
  map.add(adjustment(20 * kSecondNs, kHostNs + 22 * kSecondNs, kHostNs + 22 * kSecondNs, 1000));
  EXPECT_EQ(mapped(map, 10 * kSecondNs - 1), kHostNs + 10 * kSecondNs - 1) << "before the step";
  EXPECT_EQ(mapped(map, 10 * kSecondNs), kHostNs + 12 * kSecondNs);
  EXPECT_EQ(mapped(map, 19 * kSecondNs), kHostNs + 21 * kSecondNs);
  EXPECT_EQ(mapped(map, 21 * kSecondNs), kHostNs + 23 * kSecondNs + 1000);
}

TEST(ClockMap, KeepsARateForHours) {
  ClockMap map;
  map.add(adjustment(0, kHostNs, kHostNs, 1));  // 1e-9
  constexpr std::int64_t kDayNs = 86'400 * kSecondNs;
  EXPECT_EQ(mapped(map, kDayNs), kHostNs + kDayNs + 86'400);
}

TEST(ClockMap, OneNotLaterReplaces) {
  ClockMap map;
  map.add(adjustment(0, 0, 0, 0));
  map.add(adjustment(100, 100, 500, 0));
  map.add(adjustment(100, 500, 900, 0));
  EXPECT_EQ(map.segments(), 2U);
  EXPECT_EQ(mapped(map, 100), 900);
  EXPECT_EQ(mapped(map, 99), 99);
  map.add(adjustment(50, 50, 60, 0));
  EXPECT_EQ(mapped(map, 100), 110);
}

TEST(ClockMap, ForgetsTheOldest) {
  ClockMap map;
  const auto segments = static_cast<std::int64_t>(ClockMap::kMaxSegments);
  for (std::int64_t i = 0; i < segments + 10; ++i) {
    map.add(adjustment(1000 * i, 1001 * i, 1001 * i + 1, 0));
  }
  EXPECT_EQ(map.segments(), ClockMap::kMaxSegments);
  EXPECT_EQ(mapped(map, 10'000), 10'011);
  EXPECT_EQ(mapped(map, 9'999), 10'009) << "the oldest segment's line back from its `before`";
  EXPECT_EQ(mapped(map, 1000 * segments), 1001 * segments + 1);
}

TEST(ClockMap, StaysFinite) {
  constexpr std::int64_t kHigh = std::numeric_limits<std::int64_t>::max();
  ClockMap map;
  map.add(adjustment(-kHigh, kHigh, kHigh, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(mapped(map, kHigh), kHigh);
  map.add(adjustment(0, 0, 7, std::numeric_limits<double>::infinity()));
  EXPECT_EQ(mapped(map, 1), 8);
}

}  // namespace
}  // namespace simbench
