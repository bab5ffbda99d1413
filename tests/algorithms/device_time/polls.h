// Polls of a camera's clock for the tests of two-way device time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "algorithms/device_time/device_time.h"
#include "tests/algorithms/device_time/streams.h"

namespace simbench {

// The camera's reading at host time `t_ns` after kHostZeroNs, rounded to 1 us.
inline std::int64_t device_us_at(std::int64_t t_ns, double fast_ppm) {
  const double t_us = 1e-3 * static_cast<double>(t_ns);
  return kDeviceZeroUs + std::llround(t_us * (1 + 1e-6 * fast_ppm));
}

inline PollSample poll_at(std::int64_t t0_ns, std::int64_t request_ns, std::int64_t reply_ns,
                          double fast_ppm = 0) {
  const std::int64_t read_ns = t0_ns + request_ns;
  const std::int64_t t1_ns = read_ns + reply_ns;
  return {.device = DeviceTime(Microseconds(device_us_at(read_ns, fast_ppm))),
          .t0 = HostTime(Nanoseconds(kHostZeroNs + t0_ns)),
          .t1 = HostTime(Nanoseconds(kHostZeroNs + t1_ns)),
          .t0_steady = SteadyTime(Nanoseconds(t0_ns)),
          .t1_steady = SteadyTime(Nanoseconds(t1_ns))};
}

// The delays of one poll.
struct PollDelay {
  double request_ms = 0;
  double reply_ms = 0;
};

// Errors in ms of frames at 30 fps from `from_s` to `to_s`, each stamped as soon as it is exposed.
// A poll that takes delay_ms() begins 100 ms after the one before has ended.
inline std::vector<double> poll_errors_ms(DeviceTimeEstimator& estimator,
                                          const std::function<PollDelay()>& delay_ms,
                                          double fast_ppm, double from_s, double to_s) {
  std::vector<double> errors;
  PollSample poll;
  std::int64_t poll_end_ns = -100'000'000;
  const auto next_poll = [&] {
    const PollDelay delay = delay_ms();
    const std::int64_t t0_ns = poll_end_ns + 100'000'000;
    const std::int64_t request_ns = std::llround(1e6 * delay.request_ms);
    const std::int64_t reply_ns = std::llround(1e6 * delay.reply_ms);
    poll = poll_at(t0_ns, request_ns, reply_ns, fast_ppm);
    poll_end_ns = t0_ns + request_ns + reply_ns;
  };
  next_poll();
  for (std::int64_t i = 0; i < std::llround(to_s * 30); ++i) {
    const std::int64_t frame_ns = i * 1'000'000'000 / 30;
    while (poll_end_ns <= frame_ns) {
      estimator.on_poll(poll);
      next_poll();
    }
    const GlobalTime stamp =
        estimator.stamp(sample_at(device_us_at(frame_ns, fast_ppm), kHostZeroNs + frame_ns));
    if (1e-9 * static_cast<double>(frame_ns) < from_s) continue;
    errors.push_back(1e-6 * error_ns(stamp, kHostZeroNs + frame_ns));
  }
  return errors;
}

struct ErrorStatistics {
  double mean = 0;
  double deviation = 0;
  double least = 0;
  double largest = 0;
};

inline ErrorStatistics statistics(const std::vector<double>& errors) {
  ErrorStatistics all;
  const auto count = static_cast<double>(errors.size());
  for (const double error : errors) all.mean += error / count;
  for (const double error : errors) all.deviation += std::pow(error - all.mean, 2) / count;
  all.deviation = std::sqrt(all.deviation);
  all.least = *std::min_element(errors.begin(), errors.end());
  all.largest = *std::max_element(errors.begin(), errors.end());
  return all;
}

}  // namespace simbench
