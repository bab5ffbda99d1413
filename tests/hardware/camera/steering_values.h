// What the tests of steered cameras agree on.
#pragma once

#include "hardware/camera/camera.h"

namespace simbench::hardware {

// Frames of 4 ms, in granules of 10 us.
inline FrameSteering steering_settings(std::uint32_t latency_frames = 2) {
  FrameSteering settings;
  settings.limits = {.frame_length = std::chrono::milliseconds(4),
                     .shortest = std::chrono::milliseconds(2),
                     .longest = std::chrono::milliseconds(20),
                     .granularity = std::chrono::microseconds(10),
                     .exposure = std::chrono::milliseconds(1),
                     .latency_frames = latency_frames,
                     .allowed = {true, true, true, true}};
  return settings;
}

}  // namespace simbench::hardware
