// Streams of one camera's (sensor stamp, arrival) for the tests of device_time.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithms/device_time/device_time.h"

namespace simbench {

// Where the clocks of the tests start: a host's system clock in the year 2023, a camera that has
// run for an hour.
inline constexpr std::int64_t kHostZeroNs = 1'700'000'000'123'456'789;
inline constexpr std::int64_t kDeviceZeroUs = 3'600'000'000;

inline DeviceSample sample_at(std::int64_t sensor_us, std::int64_t arrival_ns) {
  return {.sensor = DeviceTime(Microseconds(sensor_us)),
          .arrival = HostTime(Nanoseconds(arrival_ns)),
          .arrival_steady = SteadyTime(Nanoseconds(arrival_ns)),
          .exposure_us = 5000};
}

// A device whose clock runs slow by `rate_ppm` of the host's: arrivals lie exactly on a line,
// `latency_ns` after the exposure. period_us * rate_ppm must be a multiple of 1000.
inline std::vector<DeviceSample> line(std::int64_t frames, std::int64_t period_us,
                                      std::int64_t rate_ppm, std::int64_t latency_ns) {
  std::vector<DeviceSample> samples;
  for (std::int64_t i = 0; i < frames; ++i) {
    const std::int64_t sensor_us = i * period_us;
    samples.push_back(
        sample_at(kDeviceZeroUs + sensor_us,
                  kHostZeroNs + 1000 * sensor_us + sensor_us * rate_ppm / 1000 + latency_ns));
  }
  return samples;
}

inline std::vector<GlobalTime> stamps(DeviceTimeEstimator& estimator,
                                      const std::vector<DeviceSample>& samples) {
  if (estimator.offline()) estimator.learn(samples);
  std::vector<GlobalTime> all;
  all.reserve(samples.size());
  for (const DeviceSample& sample : samples) all.push_back(estimator.stamp(sample));
  return all;
}

inline double error_ns(GlobalTime stamp, std::int64_t expected_ns) {
  return static_cast<double>(nanoseconds_of(stamp) - expected_ns);
}

}  // namespace simbench
