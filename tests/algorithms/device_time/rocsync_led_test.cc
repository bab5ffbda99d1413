#include "algorithms/device_time/rocsync_led.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "algorithms/registry.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

constexpr std::int64_t kLedZeroNs = 150'000'000;
constexpr std::int64_t kTurnNs = 100'000'000;

// A camera's clock that is slow by 40 ppm, exactly: LED time at a sensor stamp.
std::int64_t led_ns_at(std::int64_t sensor_us) {
  return kLedZeroNs + 1000 * sensor_us + sensor_us * 40 / 1000;
}

LedSample sighting_at(std::int64_t sensor_us, std::int64_t wrong_ns = 0) {
  return {.sensor = DeviceTime(Microseconds(kDeviceZeroUs + sensor_us)),
          .led = Nanoseconds(led_ns_at(sensor_us) + wrong_ns)};
}

std::vector<DeviceSample> frames(std::int64_t count) {
  std::vector<DeviceSample> samples;
  for (std::int64_t i = 0; i < count; ++i) {
    // Arrivals that say nothing.
    samples.push_back(sample_at(kDeviceZeroUs + 25'000 * i, kHostZeroNs - 7'000'000'000 * i));
  }
  return samples;
}

void expect_on_line(DeviceTimeEstimator& estimator, double tolerance_ns) {
  const std::vector<DeviceSample> all = frames(2000);
  const std::vector<GlobalTime> found = stamps(estimator, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::int64_t expected_ns = led_ns_at(25'000 * static_cast<std::int64_t>(i));
    ASSERT_NEAR(error_ns(found[i], expected_ns), 0, tolerance_ns) << i;
  }
}

TEST(RocsyncLed, FindsTheLineThatTheSightingsLieOn) {
  const auto estimator = make_rocsync_led();
  EXPECT_TRUE(estimator->offline());
  EXPECT_TRUE(estimator->relative());
  // Five looks at the beginning, five at the end.
  for (const std::int64_t i : {2, 3, 4, 5, 6, 1990, 1991, 1992, 1993, 1994}) {
    estimator->on_led_sighting(sighting_at(25'000 * i));
  }
  expect_on_line(*estimator, 1);
}

TEST(RocsyncLed, ReadingsThatAreATurnWrongAreLeftOut) {
  const auto estimator = make_rocsync_led();
  for (std::int64_t i = 0; i < 400; ++i) {
    const std::int64_t wrong_ns = i % 4 != 0 ? 0 : i % 8 == 0 ? kTurnNs : -kTurnNs;
    estimator->on_led_sighting(sighting_at(125'000 * i, wrong_ns));
  }
  expect_on_line(*estimator, 1);
}

// All of them late: least squares would be 20 ms off in the mean.
TEST(RocsyncLed, AFifthOfOneSidedErrorsLeavesNothing) {
  const auto estimator = make_rocsync_led();
  for (std::int64_t i = 0; i < 1000; ++i) {
    estimator->on_led_sighting(sighting_at(50'000 * i, i % 5 == 0 ? kTurnNs : 0));
  }
  expect_on_line(*estimator, 1);
}

TEST(RocsyncLed, TheThresholdIsThatOfTheResidual) {
  for (const bool is_wide : {false, true}) {
    const auto estimator = make_rocsync_led({.threshold_ms = is_wide ? 101.0 : 99.0});
    for (std::int64_t i = 0; i < 1000; ++i) {
      estimator->on_led_sighting(sighting_at(50'000 * i, i % 5 == 0 ? kTurnNs : 0));
    }
    const std::vector<DeviceSample> all = frames(1001);
    const double error = error_ns(stamps(*estimator, all)[1000], led_ns_at(25'000'000));
    EXPECT_NEAR(error, is_wide ? 20e6 : 0, 0.1e6) << is_wide;
  }
}

// Uniform within half a millisecond, as whole steps leave a begin; 1000 of them over 50 s. The line
// at its ends has twice the standard error of the mean.
TEST(RocsyncLed, StepsAverageOut) {
  const auto estimator = make_rocsync_led();
  for (std::int64_t i = 0; i < 1000; ++i) {
    estimator->on_led_sighting(sighting_at(50'000 * i, (i * 619) % 1000 * 1000 - 499'500));
  }
  expect_on_line(*estimator, 4 * 2 * 0.2887e6 / 31.6);
}

TEST(RocsyncLed, OneSightingGivesTheCamerasOwnRate) {
  const auto estimator = make_rocsync_led();
  estimator->on_led_sighting(sighting_at(1'000'000));
  const std::vector<GlobalTime> found = stamps(*estimator, frames(81));
  EXPECT_EQ(nanoseconds_of(found[40]), led_ns_at(1'000'000));
  EXPECT_EQ(nanoseconds_of(found[80]), led_ns_at(1'000'000) + 1'000'000'000);
}

TEST(RocsyncLed, SightingsAtOneStampGiveTheirMean) {
  const auto estimator = make_rocsync_led();
  for (const std::int64_t wrong_ns : {-500'000, 100'000, 400'000, 2'000'000}) {
    estimator->on_led_sighting(sighting_at(1'000'000, wrong_ns));
  }
  EXPECT_EQ(nanoseconds_of(stamps(*estimator, frames(41))[40]), led_ns_at(1'000'000) + 500'000);
}

TEST(RocsyncLed, OfTwoThatContradictEachOtherBothCount) {
  const auto estimator = make_rocsync_led();
  estimator->on_led_sighting(sighting_at(1'000'000));
  estimator->on_led_sighting(sighting_at(1'000'000, kTurnNs));
  EXPECT_EQ(nanoseconds_of(stamps(*estimator, frames(41))[40]), led_ns_at(1'000'000) + kTurnNs / 2);
}

TEST(RocsyncLed, WithoutSightingsStampsCountFromTheFirstFrame) {
  const auto estimator = make_rocsync_led();
  const std::vector<GlobalTime> found = stamps(*estimator, frames(11));
  EXPECT_EQ(nanoseconds_of(found[0]), 0);
  EXPECT_EQ(nanoseconds_of(found[10]), 250'000'000);
}

TEST(RocsyncLed, NeedsAnLedClock) {
  const DeviceTimeEntry* entry = find_algorithm<DeviceTimeEntry>("rocsync_led");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->info.needs, std::vector<Need>{Need::kLedClock});
  EXPECT_THROW(check_parameters(entry->info.parameters, {{"threshold_ms", 0.0}}), ParameterError);
}

}  // namespace
}  // namespace simbench
