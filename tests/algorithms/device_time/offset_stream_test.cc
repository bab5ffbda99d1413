#include "algorithms/device_time/offset_stream.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

using Sample = OffsetStream::Sample;

// A stream that has seen one sample: sensor at kDeviceZeroUs, arrival at kHostZeroNs.
OffsetStream started() {
  OffsetStream stream;
  EXPECT_EQ(stream.push(sample_at(kDeviceZeroUs, kHostZeroNs)), Sample::kFirst);
  return stream;
}

Sample next(std::int64_t sensor_us, std::int64_t arrival_ns) {
  OffsetStream stream = started();
  return stream.push(sample_at(kDeviceZeroUs + sensor_us, kHostZeroNs + arrival_ns));
}

TEST(OffsetStream, CountsFromTheFirst) {
  OffsetStream stream = started();
  EXPECT_EQ(stream.point().x, 0);
  EXPECT_EQ(stream.point().y, 0);
  EXPECT_EQ(stream.push(sample_at(kDeviceZeroUs + 20'000, kHostZeroNs + 20'001'500)),
            Sample::kNext);
  EXPECT_EQ(stream.point().x, 20'000);
  EXPECT_EQ(stream.point().y, 1500);
  EXPECT_EQ(nanoseconds_of(stream.stamp(-250.4)), kHostZeroNs + 20'000'000 - 250);
}

TEST(OffsetStream, OneNotLaterIsLate) {
  EXPECT_EQ(next(0, 0), Sample::kLate);
  EXPECT_EQ(next(-1'000'000, 0), Sample::kLate);
  OffsetStream stream = started();
  stream.push(sample_at(kDeviceZeroUs + 100, kHostZeroNs + 100'000));
  EXPECT_EQ(stream.push(sample_at(kDeviceZeroUs + 50, kHostZeroNs + 110'000)), Sample::kLate);
  EXPECT_EQ(stream.point().x, 50) << "it is stamped all the same";
  EXPECT_EQ(stream.push(sample_at(kDeviceZeroUs + 99, kHostZeroNs + 110'000)), Sample::kLate);
}

TEST(OffsetStream, ACameraOrClockThatWasSetBeginsAnew) {
  EXPECT_EQ(next(-1'000'001, 0), Sample::kFirst);
  EXPECT_EQ(next(20'000, 20'000'000 + kSecondNs), Sample::kNext);
  EXPECT_EQ(next(20'000, 20'000'000 + kSecondNs + 20'001), Sample::kFirst);
  EXPECT_EQ(next(20'000, 20'000'000 - kSecondNs - 20'000), Sample::kNext);
  EXPECT_EQ(next(20'000, 20'000'000 - kSecondNs - 20'001), Sample::kFirst);
}

TEST(OffsetStream, GapsOfHoursGoOn) {
  constexpr std::int64_t kHoursUs = 10LL * 3600 * 1'000'000;
  for (const std::int64_t drift_ppm : {0, 300, -300, 1000, -1000}) {
    EXPECT_EQ(next(kHoursUs, 1000 * kHoursUs + drift_ppm * kHoursUs / 1000), Sample::kNext)
        << drift_ppm;
  }
  EXPECT_EQ(next(kHoursUs, 0), Sample::kFirst) << "the host's clock stood still";
}

TEST(OffsetStream, AnythingStaysWithinReach) {
  constexpr std::int64_t kHigh = std::numeric_limits<std::int64_t>::max();
  OffsetStream stream;
  for (const std::int64_t sensor : {kHigh / 1000, -kHigh / 1000, std::int64_t{0}}) {
    for (const std::int64_t arrival : {kHigh, -kHigh, std::int64_t{0}}) {
      stream.push(sample_at(sensor, arrival));
      EXPECT_LE(std::abs(stream.point().x), OffsetStream::kReach);
      EXPECT_LE(std::abs(stream.point().y), OffsetStream::kReach);
    }
  }
}

}  // namespace
}  // namespace simbench
