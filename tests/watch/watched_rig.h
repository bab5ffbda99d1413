// Cameras made by hand: on a grid of pulses, with arrivals that jitter by the same numbers each
// time.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "recording/recorded_streams.h"

namespace simbench::watch {

// From 0 to 1, always the same (splitmix64).
inline double chance(std::size_t camera, int pulse) {
  std::uint64_t z = (camera * 1'000'003 + static_cast<std::uint64_t>(pulse)) * 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

struct WatchedRig {
  std::size_t cameras = 3;
  double period_ms = 1000.0 / 30;
  double jitter_ms = 1;  // uniform, one-sided
  // How much later a camera's frame is, by camera and pulse.
  std::function<double(std::size_t, int)> later_ms = [](std::size_t, int) { return 0.0; };
  // Whether a frame arrives; the counter counts it in any case.
  std::function<bool(std::size_t, int)> arrives = [](std::size_t, int) { return true; };

  // The frames of these pulses.
  std::vector<RecordedStream> frames(int from, int to) const {
    std::vector<RecordedStream> streams;
    for (std::size_t camera = 0; camera < cameras; ++camera) {
      RecordedStream stream{
          .camera = "c" + std::to_string(camera), .host = "pc", .stream = "Depth 0", .frames = {}};
      for (int pulse = from; pulse < to; ++pulse) {
        if (!arrives(camera, pulse)) continue;
        const double noise = jitter_ms * chance(camera, pulse);
        const double ms = 10'000 + pulse * period_ms + 2 * static_cast<double>(camera) +
                          later_ms(camera, pulse) + noise;
        const Nanoseconds at(static_cast<std::int64_t>(std::llround(ms * 1e6)));
        stream.frames.push_back(
            {.counter = static_cast<std::uint64_t>(pulse + 100), .sensor = at, .arrival = at});
      }
      streams.push_back(std::move(stream));
    }
    return streams;
  }
};

}  // namespace simbench::watch
