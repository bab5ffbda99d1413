// The stream of a camera whose clock has a constant rate.
#pragma once

#include <cstdint>
#include <string>

#include "algorithms/ports/time.h"
#include "recording/recorded_streams.h"

namespace simbench::evaluation {

inline constexpr double kSteadyPeriodMs = 33.0;

inline double no_latency(int) { return 0; }

// Its clock runs `drift_ppm` slow against the host's; frame i arrives `latency(i)` ms late.
template <class Latency>
RecordedStream steady_stream(const std::string& name, int frames, double drift_ppm,
                             const Latency& latency, double first_sensor_ms = 5000) {
  RecordedStream stream{.camera = name, .host = name, .stream = "Depth 0", .frames = {}};
  for (int i = 0; i < frames; ++i) {
    const double host_ms = i * kSteadyPeriodMs;
    stream.frames.push_back({.counter = static_cast<std::uint64_t>(i + 1),
                             .sensor = from_ms(first_sensor_ms + host_ms / (1 + drift_ppm * 1e-6)),
                             .arrival = from_ms(100 + host_ms + latency(i))});
  }
  return stream;
}

}  // namespace simbench::evaluation
