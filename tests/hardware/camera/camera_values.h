// Short ways to write what the camera tests configure.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hardware/camera/camera.h"
#include "hardware/rig/rig.h"

namespace simbench::hardware {

inline scenarios::Stream stream(const std::string& kind, double mode_rate_hz, int width = 640,
                                int height = 480) {
  scenarios::Stream result;
  result.kind = scenarios::from_text<StreamKind>(kind).value();
  result.mode_rate_hz = mode_rate_hz;
  result.width = width;
  result.height = height;
  return result;
}

inline CameraSettings settings(const std::string& sync_mode, std::vector<scenarios::Stream> streams,
                               double trigger_rate_hz = 0) {
  CameraSettings result;
  result.sync_mode = scenarios::from_text<scenarios::SyncMode>(sync_mode).value();
  result.streams = std::move(streams);
  result.trigger_rate_hz = trigger_rate_hz;
  return result;
}

inline RigCamera recorded(const std::string& serial, const std::string& recording,
                          const std::string& recorded_camera = "",
                          const std::string& trigger_file = "") {
  return {serial, recording, recorded_camera, trigger_file};
}

}  // namespace simbench::hardware
