// The frames of a recording as they are played: when each is due, and what it carries.
//
// A recording is a folder of recording/recording_folder.h (its first capture, or the one that
// "FOLDER#PIPELINE" or "FOLDER#PIPELINE/SEED" names) or a file of
// real cameras (bags/recorded_files.h). It is read
// once for all its wanted cameras; only their frames are kept, 40 bytes each.
//
// Due times count from the recording's zero, which all its cameras share:
//  - with truth, the earliest start of an exposure that a trigger pulse began. A frame is due at
//    its true mid-exposure plus its delay by its host's steady clock: the player replays the
//    recorded world with clocks of its own;
//  - without truth (and where no pulse began an exposure), the earliest arrival.
//
// Errors: CameraError that names the camera: an unreadable recording, an unknown capture or camera
// (the message lists the known ones), no frame of the camera, frames with and without truth.
// Complexity: linear in the recording.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hardware/rig/rig.h"
#include "recording/recording.h"

namespace simbench::hardware {

// Stands for the back-end stamp where a recording has none.
inline constexpr std::int32_t kNoBackend = std::numeric_limits<std::int32_t>::max();
// Stands for the begin of the exposure where a recording has no truth.
inline constexpr std::int32_t kNoExposure = kNoBackend;

struct PlayedFrame {
  std::int64_t due_ns = 0;  // after the recording's zero
  std::uint32_t counter = 0;
  std::uint32_t exposure_us = 0;
  DeviceStamp sensor;
  DeviceStamp frame;
  std::int32_t backend_lead_ns = kNoBackend;    // from the back-end stamp to the arrival
  std::int32_t exposure_lead_ns = kNoExposure;  // from the begin of the exposure to that
  StreamKind stream = StreamKind::kDepth;
  StampDomain domain = StampDomain::kHardwareClock;
};

struct PlayedCamera {
  std::string name;                 // in the recording
  std::vector<PlayedFrame> frames;  // in order of due time; at least one
  // What was left out of the recording, a line each; only of the first wanted camera.
  std::vector<std::string> notes{};
};

// One for each of `wanted`, which are cameras of one recording.
std::vector<std::shared_ptr<const PlayedCamera>> load_played_cameras(
    const std::string& recording, const std::vector<RigCamera>& wanted);

}  // namespace simbench::hardware
