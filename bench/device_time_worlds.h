// The worlds in which device_time estimators are compared: one camera, one host, no rig.
//
// 45 fps by the device's own clock for 300 s, that clock 20 ppm fast with stamps rounded to 1 us,
// arrivals in order, D + e late with D = 8 ms and e = Exp(0.3 ms) + 1 % U(5, 20) ms. Beside them
// polls of the device's clock every 100 ms, 0.3 ms + Exp(0.1 ms) each way. The host's clock is
// true.
//
// A stamp's error is taken against exposure + D, since no one-way method can know D; a two-way
// method is D early by that measure.
// Source: docs/reference/device_time.md section 3.
#pragma once

#include <algorithm>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "algorithms/device_time/device_time.h"

namespace simbench {

struct DeviceTimeWorld {
  double rate_hz = 45;
  double length_s = 300;
  double skew_ppm = 20;
  double sinusoid_ppm = 0;  // in the skew, period 300 s: 5 in world B
  double drop_probability = 0;
  double host_step_ms = 0;  // of the host's clock, at half of the length
  std::int64_t arrival_quantum_ns = 1000;
  static constexpr double kDelayMs = 8;
};

struct DeviceTimeRun {
  std::vector<DeviceSample> frames;
  std::vector<double> true_s;              // of each frame's exposure
  std::vector<std::int64_t> undelayed_ns;  // on the host's clock: exposure + D
  std::vector<PollSample> polls;           // in order of t1
};

namespace device_time_world {

inline constexpr std::int64_t kHostZeroNs = 1'700'000'000'000'000'000;
inline constexpr double kDeviceZeroUs = 3.6e9;

inline double device_us(const DeviceTimeWorld& world, double t_s) {
  constexpr double kPeriodS = 300;
  const double phase = 2 * std::numbers::pi * t_s / kPeriodS;
  const double wave_us =
      world.sinusoid_ppm * kPeriodS / (2 * std::numbers::pi) * (1 - std::cos(phase));
  return kDeviceZeroUs + 1e6 * t_s + world.skew_ppm * t_s + wave_us;
}

// The true time at which the device's clock has counted `counted_s` since its zero.
inline double true_s(const DeviceTimeWorld& world, double counted_s) {
  double t_s = counted_s;
  for (int i = 0; i < 3; ++i) {
    t_s += counted_s - 1e-6 * (device_us(world, t_s) - kDeviceZeroUs);
  }
  return t_s;
}

inline std::int64_t host_ns(const DeviceTimeWorld& world, double t_s) {
  const double step_ns = t_s >= world.length_s / 2 ? 1e6 * world.host_step_ms : 0;
  return kHostZeroNs + std::llround(1e9 * t_s + step_ns);
}

inline std::vector<PollSample> polls(const DeviceTimeWorld& world, std::uint32_t seed) {
  boost::random::mt19937 random(seed + 1'000'000);
  boost::random::exponential_distribution<double> excess_s(1 / 0.1e-3);
  std::vector<PollSample> all;
  for (double t0_s = 0; t0_s < world.length_s; t0_s += 0.1) {
    const double read_s = t0_s + 0.3e-3 + excess_s(random);
    const double t1_s = read_s + 0.3e-3 + excess_s(random);
    all.push_back({.device = DeviceTime(Microseconds(std::llround(device_us(world, read_s)))),
                   .t0 = HostTime(Nanoseconds(host_ns(world, t0_s))),
                   .t1 = HostTime(Nanoseconds(host_ns(world, t1_s))),
                   .t0_steady = SteadyTime(Nanoseconds(host_ns({}, t0_s))),
                   .t1_steady = SteadyTime(Nanoseconds(host_ns({}, t1_s)))});
  }
  return all;
}

}  // namespace device_time_world

inline DeviceTimeRun make_device_time_run(const DeviceTimeWorld& world, std::uint32_t seed) {
  using namespace device_time_world;  // NOLINT(google-build-using-namespace)
  boost::random::mt19937 random(seed);
  boost::random::exponential_distribution<double> excess_s(1 / 0.3e-3);
  boost::random::uniform_real_distribution<double> unit(0, 1);
  DeviceTimeRun run;
  run.polls = polls(world, seed);
  double newest_s = 0;
  const auto frames = static_cast<std::int64_t>(world.rate_hz * world.length_s);
  for (std::int64_t i = 0; i < frames; ++i) {
    const double exposed_s = true_s(world, static_cast<double>(i) / world.rate_hz);
    double late_s = excess_s(random);
    if (unit(random) < 0.01) late_s += 5e-3 + 15e-3 * unit(random);
    newest_s = std::max(newest_s, exposed_s + 1e-3 * DeviceTimeWorld::kDelayMs + late_s);
    if (unit(random) < world.drop_probability) continue;
    const std::int64_t arrival_ns = host_ns(world, newest_s);
    run.frames.push_back(
        {.sensor = DeviceTime(Microseconds(std::llround(device_us(world, exposed_s)))),
         .arrival = HostTime(Nanoseconds(arrival_ns - arrival_ns % world.arrival_quantum_ns)),
         .arrival_steady = SteadyTime(Nanoseconds(host_ns({}, newest_s))),
         .exposure_us = 5000});
    run.true_s.push_back(exposed_s);
    run.undelayed_ns.push_back(host_ns(world, exposed_s) +
                               std::llround(1e6 * DeviceTimeWorld::kDelayMs));
  }
  return run;
}

// An estimator's stamps of a run, with the polls that had ended before each frame arrived.
inline std::vector<GlobalTime> device_time_stamps(DeviceTimeEstimator& estimator,
                                                  const DeviceTimeRun& run) {
  std::size_t polled = 0;
  if (estimator.offline()) estimator.learn(run.frames);
  std::vector<GlobalTime> stamps;
  for (const DeviceSample& frame : run.frames) {
    for (; polled < run.polls.size() && run.polls[polled].t1 <= frame.arrival; ++polled) {
      estimator.on_poll(run.polls[polled]);
    }
    stamps.push_back(estimator.stamp(frame));
  }
  return stamps;
}

// Errors after the first `skip_s`, in us. Over runs, bias and std are means and worst is the worst.
struct DeviceTimeErrors {
  double bias_us = 0;
  double std_us = 0;
  double worst_us = 0;
};

inline DeviceTimeErrors device_time_errors(const DeviceTimeRun& run,
                                           const std::vector<GlobalTime>& stamps,
                                           double skip_s = 60) {
  double count = 0;
  double mean = 0;
  double squares = 0;
  DeviceTimeErrors errors;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (run.true_s[i] <= skip_s) continue;
    const double error_us =
        1e-3 * static_cast<double>(nanoseconds_of(stamps[i]) - run.undelayed_ns[i]);
    const double from_old_mean = error_us - mean;
    mean += from_old_mean / ++count;
    squares += from_old_mean * (error_us - mean);
    errors.worst_us = std::max(errors.worst_us, std::abs(error_us));
  }
  errors.bias_us = mean;
  errors.std_us = std::sqrt(squares / count);
  return errors;
}

}  // namespace simbench
