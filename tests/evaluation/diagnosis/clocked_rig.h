// Recordings and logs with known clocks of the hosts, for tests of the account of clocks.
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include "evaluation/diagnosis/logged_clock.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

inline constexpr double kRigPeriodMs = 1000.0 / 30;
inline constexpr double kRigDayS = 1725359400;  // 2024-09-03 10:30:00 UTC

using ClockErrorS = std::function<double(double since_start_s)>;

inline double keeps_time(double) { return 0; }

// A camera that exposes a frame per period of true time.
struct ClockRigCamera {
  std::string name;
  std::string host = "A";
  double start_s = 0;  // of the arrivals' scale
  ClockErrorS error_s = keeps_time;
  double phase_ms = 0;
  double delay_ms = 9;
  double delivery_sd_ms = 0.1;
  double stamp_sd_ms = 0.01;  // of the exposures' start: stamp and arrival have it
  double clock_ppm = 40;
  std::int64_t frames = 1800;
  std::uint32_t seed = 1;
};

inline RecordedStream rig_recording(const ClockRigCamera& camera) {
  boost::random::mt19937 random(camera.seed * 7919 + static_cast<unsigned char>(camera.name[0]));
  boost::random::normal_distribution<double> noise(0, 1);
  RecordedStream stream = {camera.name, camera.host, "Depth 0", {}};
  for (std::int64_t i = 0; i < camera.frames; ++i) {
    const double at_ms = camera.phase_ms + static_cast<double>(i) * kRigPeriodMs +
                         camera.stamp_sd_ms * noise(random);
    const double arrival_ms = at_ms + camera.delay_ms + camera.delivery_sd_ms * noise(random);
    const double error_s = camera.error_s(1e-3 * arrival_ms);
    stream.frames.push_back(
        {.counter = static_cast<std::uint64_t>(i + 1),
         .sensor = from_ms(5000 + at_ms * (1 + 1e-6 * camera.clock_ppm)),
         .arrival = from_seconds(camera.start_s) + from_ms(arrival_ms + 1e3 * error_s)});
  }
  return stream;
}

// A point an interval, from `from_s` after the start on.
struct ClockRigLog {
  std::string file = "clock.csv";
  std::string format = "csv";
  double start_s = 0;  // of the log's scale
  double from_s = -5;
  double until_s = 70;
  double interval_s = 1;
  ClockErrorS error_s = keeps_time;
  double noise_s = 1e-6;
};

inline ClockLog rig_log(const ClockRigLog& log) {
  boost::random::mt19937 random(5);
  boost::random::normal_distribution<double> noise(0, 1);
  ClockLog made{.path = log.file, .format = log.format};
  for (double at_s = log.from_s; at_s <= log.until_s; at_s += log.interval_s) {
    const Microseconds time(std::llround(1e6 * (log.start_s + at_s)));
    made.points.push_back({time, log.error_s(at_s) + log.noise_s * noise(random)});
  }
  return made;
}

// 0 before a time, and so much from then on.
inline ClockErrorS step_at(double at_s, double by_s) {
  return [=](double now_s) { return now_s < at_s ? 0 : by_s; };
}

}  // namespace simbench::evaluation
