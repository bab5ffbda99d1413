// Recordings in the two forms that app/ibl_recording.h reads: generated ones, whose drift, delays
// and gaps are known, and real ones, which are not the project's to carry.
//
//   const std::string text = ibl_timestamps({.drift_ppm = -215});
//   TEST(...) { SIMBENCH_SKIP_WITHOUT(kRealBody); ... }
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace simbench {

// Where recordings of other people are: in ../shared/data, beside the project, or in the folder
// that the environment names.
inline std::string shared_data_path(const std::string& name) {
  const char* folder = std::getenv("SIMBENCH_SHARED_DATA");
  return (folder ? std::string(folder) : SIMBENCH_SOURCE_DIR "/../shared/data") + "/" + name;
}
inline const std::string kRealBody = shared_data_path("ibl/_iblrig_bodyCamera.timestamps.ssv");
inline const std::string kRealLeft = shared_data_path("ibl/_iblrig_leftCamera.frameData.bin");

// In the body of a test or in SetUp().
#define SIMBENCH_SKIP_WITHOUT(path)                                                             \
  if (!std::filesystem::exists(path)) {                                                         \
    GTEST_SKIP() << "there is no " << (path) << "; tests/data/README.md says where it is from"; \
  }

// A camera at 30.19 FPS whose frames arrive with an exponential delay.
struct IblWorld {
  std::int64_t frames = 6001;           // that the camera exposes
  double drift_ppm = -215;              // the rate of the host's clock against the camera's, less 1
  double mean_delay_ms = 0.2;           // above the smallest, which is 0
  std::vector<std::int64_t> lost = {};  // numbers of frames that the file lacks
};
inline constexpr std::int64_t kIblTicksPerSecond = 8000 * 3072;  // of the camera's cycle clock
inline constexpr std::int64_t kIblPeriodTicks = 814'080;
inline constexpr double kIblPeriodMs = 33.125;

struct IblFrame {
  std::int64_t number;
  std::uint32_t reading;     // of the cycle clock
  std::int64_t host_100_ns;  // since the first exposure
};

// The readings begin 20 s before the cycle clock starts anew at 128 s.
inline std::vector<IblFrame> ibl_frames(const IblWorld& world) {
  std::mt19937_64 bits(7);
  std::vector<IblFrame> frames;
  for (std::int64_t number = 0; number < world.frames; ++number) {
    const std::int64_t ticks = 108 * kIblTicksPerSecond + number * kIblPeriodTicks;
    const std::int64_t in_second = ticks % kIblTicksPerSecond;
    const double uniform = static_cast<double>(bits() >> 11) * 0x1p-53;
    const double host_ms =
        static_cast<double>(number) * kIblPeriodMs * (1 + 1e-6 * world.drift_ppm) -
        world.mean_delay_ms * std::log1p(-uniform);
    if (std::count(world.lost.begin(), world.lost.end(), number) > 0) continue;
    frames.push_back(
        {.number = number,
         .reading = static_cast<std::uint32_t>((ticks / kIblTicksPerSecond % 128) << 25 |
                                               (in_second / 3072) << 12 | in_second % 3072),
         .host_100_ns = std::llround(1e4 * host_ms)});
  }
  return frames;
}

// A *.timestamps.ssv, which has no counter. It begins an hour before noon.
inline std::string ibl_timestamps(const IblWorld& world = {}) {
  std::string text;
  for (const IblFrame& frame : ibl_frames(world)) {
    const std::int64_t s = frame.host_100_ns / 10'000'000;
    text += fmt::format("2020-08-19T11:{:02}:{:02}.{:07}-04:00 {} \n", s / 60, s % 60,
                        frame.host_100_ns % 10'000'000, frame.reading);
  }
  return text;
}

// A *.frameData.bin, whose counter begins at 1000.
inline std::string ibl_frame_data(const IblWorld& world = {}) {
  std::string bytes;
  for (const IblFrame& frame : ibl_frames(world)) {
    const std::array<double, 4> cells = {static_cast<double>(frame.host_100_ns),
                                         static_cast<double>(frame.reading),
                                         static_cast<double>(1000 + frame.number), 0};
    bytes.append(reinterpret_cast<const char*>(cells.data()), sizeof cells);
  }
  return bytes;
}

}  // namespace simbench
