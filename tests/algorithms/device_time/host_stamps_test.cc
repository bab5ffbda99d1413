#include "algorithms/device_time/host_stamps.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "tests/algorithms/device_time/registered.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {
namespace {

constexpr std::int64_t kRegister = std::int64_t{1} << 32;
constexpr std::int64_t kSteadyNs = 5'000'000'000'123'456;  // 58 days, the register has wrapped

// A frame that was exposed at that steady time and arrived later; the camera's reading begins
// anywhere, as unwrapping leaves it.
DeviceSample host_sample(std::int64_t exposed_steady_ns, std::int64_t latency_ns,
                         std::int64_t wraps) {
  const std::int64_t reading_us = floor_div(exposed_steady_ns, 1000) % kRegister;
  return {.sensor = DeviceTime(Microseconds(reading_us + wraps * kRegister)),
          .arrival = HostTime(Nanoseconds(kHostZeroNs + latency_ns)),
          .arrival_steady = SteadyTime(Nanoseconds(exposed_steady_ns + latency_ns)),
          .exposure_us = 5000};
}

TEST(HostStamps, AreTheExposureOnTheSystemClockWhateverTheLatency) {
  const auto estimator = make_host_stamps();
  EXPECT_FALSE(estimator->relative());
  EXPECT_FALSE(estimator->offline());
  for (const std::int64_t latency_ns : {0, 1'000, 28'300'000, 2'000'000'000}) {
    for (const std::int64_t wraps : {-3, 0, 1164}) {
      const std::int64_t stamp =
          nanoseconds_of(estimator->stamp(host_sample(kSteadyNs, latency_ns, wraps)));
      // 456 ns are below the resolution of the register.
      EXPECT_EQ(stamp, kHostZeroNs - 456) << latency_ns << ", " << wraps;
    }
  }
}

TEST(HostStamps, AcrossTheWrapOfTheRegister) {
  const auto estimator = make_host_stamps();
  const std::int64_t wrap_ns = 7 * kDeviceRegisterNs;
  for (const std::int64_t before_ns : {40'000'000, 1'000, 0, -1'000}) {
    const DeviceSample sample = host_sample(wrap_ns - before_ns, 30'000'000, 0);
    EXPECT_EQ(nanoseconds_of(estimator->stamp(sample)), kHostZeroNs) << before_ns;
  }
}

// The system clock is set between two frames: each has the reading of its own time.
TEST(HostStamps, FollowAClockThatIsSet) {
  const auto estimator = make_host_stamps();
  DeviceSample sample = host_sample(2'000'000'000, 30'000'000, 0);
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample)), kHostZeroNs);
  sample.arrival += from_ms(5);
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample)), kHostZeroNs + 5'000'000);
}

// It was set while the frame was on its way: on the steady clock the exposure lies before it.
TEST(HostStamps, TheSteadyVariantMapsAFrameFromBeforeAStep) {
  const auto estimator = make_registered("host_stamps_steady");
  estimator->on_adjustment({.host = 0,
                            .at = SteadyTime{},
                            .before = HostTime(Nanoseconds(kHostZeroNs)),
                            .after = HostTime(Nanoseconds(kHostZeroNs)),
                            .rate_ppb = 0});
  estimator->on_adjustment({.host = 0,
                            .at = SteadyTime(from_ms(1020)),
                            .before = HostTime(Nanoseconds(kHostZeroNs) + from_ms(1020)),
                            .after = HostTime(Nanoseconds(kHostZeroNs) + from_ms(1520)),
                            .rate_ppb = 0});
  DeviceSample sample = host_sample(1'000'000'000, 30'000'000, 0);
  sample.arrival = HostTime(Nanoseconds(kHostZeroNs) + from_ms(1530));
  EXPECT_EQ(nanoseconds_of(estimator->stamp(sample)), kHostZeroNs + 1'000'000'000);
}

TEST(HostStamps, NeedCamerasThatStampWithTheirHostsClock) {
  const DeviceTimeEntry* entry = find_algorithm<DeviceTimeEntry>("host_stamps");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->info.needs, std::vector<Need>{Need::kHostStamps});
}

TEST(HostStamps, AnyReadingIsWithinHalfAWrapAndNothingOverflows) {
  const auto estimator = make_host_stamps();
  constexpr std::int64_t kLow = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kHigh = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t ns : {kLow, kLow + 999, std::int64_t{-1}, std::int64_t{0}, kHigh}) {
    for (const std::int64_t us : {kLow / 1000, std::int64_t{0}, kHigh / 1000}) {
      const DeviceSample sample = sample_at(us, ns);
      const auto stamp = static_cast<double>(nanoseconds_of(estimator->stamp(sample)));
      EXPECT_NEAR(stamp, static_cast<double>(ns), 0.5 * static_cast<double>(kDeviceRegisterNs))
          << ns << ", " << us;
    }
  }
}

}  // namespace
}  // namespace simbench
