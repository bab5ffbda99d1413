// The interface of a camera, whatever its maker: all of hardware/ but one folder uses only this.
//
// Two kinds: hardware/realsense (librealsense2, where it is installed) and RecordedCamera, which
// plays a recording in real time and needs no hardware. A driver finds cameras; a camera is
// configured for a capture, started and stopped. Frames are stamps, never images.
//
// Contract
//  - The frame handler and the event handler may be called from any thread, one call at a time per
//    camera, never after stop() has returned. They must not block for long.
//  - `arrived` and `backend` are taken as early as the source allows, in monotonic time.
//  - A running camera does not throw; it reports failures as events.
//  - A camera whose frames can be steered has a CameraSteering. RealSense cameras have none: their
//    SDK has no control of the length of a frame (docs/reference/capture_alignment.md).
//
// Errors: CameraError from open(), configure() and start(): one line that names the camera, what
// was found, what is allowed or how to get it.
//
//   for (const CameraInfo& found : driver.list()) ...
//   auto camera = driver.open("018322071234");
//   camera->configure({.sync_mode = scenarios::SyncMode::kGenlock, ...});
//   camera->start([&](const CameraFrame& frame) { ... }, [&](const CameraEvent& event) { ... });
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithms/ports/frame_control.h"
#include "hardware/clock/monotonic_time.h"
#include "recording/recording.h"
#include "scenarios/scenario.h"

namespace simbench::hardware {

class CameraError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  CameraError(const std::string& serial, const std::string& problem)
      : std::runtime_error("camera " + serial + ": " + problem) {}
};

struct CameraInfo {
  std::string serial;
  std::string model;       // "Intel RealSense D455"
  std::string firmware;    // empty if the source has none
  std::string connection;  // "USB 3.2", ...
};

// What a program may change about the frames of a camera, where the camera lets it.
struct FrameSteering {
  FrameControlLimits limits{};
  std::int64_t insert_stretches = 1;  // frames that get the length of an inserted one
};

// A capture's settings of each camera, from the scenario.
struct CameraSettings {
  scenarios::SyncMode sync_mode{};
  std::vector<scenarios::Stream> streams;  // profiles
  double exposure_ms = 0;
  bool auto_exposure = false;
  double trigger_rate_hz = 0;
  std::optional<FrameSteering> steering{};  // nothing: its frames stay as they are
};

struct CameraFrame {
  StreamKind stream = StreamKind::kDepth;
  StampDomain domain = StampDomain::kHardwareClock;  // of `sensor` and `frame`
  std::uint32_t counter = 0;                         // the camera's; a gap is a lost frame
  std::uint32_t exposure_us = 0;
  DeviceStamp sensor;                    // middle of the exposure
  DeviceStamp frame;                     // start of readout and transmission
  std::optional<MonotonicTime> backend;  // where the source has one
  MonotonicTime arrived{};               // at this program
};

// An event of a camera during a capture, other than a frame.
struct CameraEvent {
  enum class Kind : std::uint8_t {
    kDisconnected,     // unplugged
    kReturned,         // plugged in again, and streaming
    kStalled,          // no frame for much longer than a period
    kMissingMetadata,  // frames lack stamps; reported once, with how to get them
    kEnded,            // the source has reached its end; not an error
    kNote,             // anything else worth a line
  };
  Kind kind = Kind::kNote;
  std::string text;  // one line for the user, without the camera's name
};

using FrameHandler = std::function<void(const CameraFrame&)>;
using CameraEventHandler = std::function<void(const CameraEvent&)>;

// The controls of the frames of one camera (algorithms/ports/frame_control.h says what they do).
// Any thread. It may outlive its camera; a camera that does not run refuses all of them.
class CameraSteering {
 public:
  virtual ~CameraSteering() = default;
  virtual const FrameControlLimits& limits() const = 0;
  // All kinds but kStartAt. `value`: a length, or by how much a frame is longer (kAdjustFrame).
  virtual FrameControlReply control(FrameControlKind kind, Nanoseconds value) = 0;
  // The next exposure begins then.
  virtual FrameControlReply start_at(MonotonicTime at) = 0;
};

// The steerings of the cameras that have one, by their numbers on the rig.
using CameraSteerings = std::map<std::uint32_t, std::shared_ptr<CameraSteering>>;

class Camera {
 public:
  virtual ~Camera() = default;
  virtual const CameraInfo& info() const = 0;
  // Refuses (CameraError) what the camera does not support. Before start().
  virtual void configure(const CameraSettings& settings) = 0;
  virtual void start(FrameHandler on_frame, CameraEventHandler on_event) = 0;
  // Idempotent; no handler runs after it.
  virtual void stop() = 0;
  // Null if its frames cannot be steered, or its settings do not say how.
  virtual std::shared_ptr<CameraSteering> steering() { return nullptr; }
};

class CameraDriver {
 public:
  virtual ~CameraDriver() = default;
  virtual std::vector<CameraInfo> list() = 0;
  virtual std::unique_ptr<Camera> open(const std::string& serial) = 0;
};

}  // namespace simbench::hardware
