// Camera models: the modes and streams of each, from one profile file per model
// (scenarios/cameras/*.json, whose schema documents every member with its range; each section names
// its source).
//
// A scenario names its model in /cameras/model; its streams and sync mode are checked against the
// profile, which also has the streams that follow the trigger in each mode. The profiles are built
// into the program; `simbench list cameras` prints them. A profile has only what the vendor
// documents: a camera without sync modes has the mode "default" alone, in which it runs free.
//
// A new model is a new file in that folder, without any other change.
//
//   const CameraProfile* camera = find_camera_profile("d455");
//   camera->triggers(SyncMode::kSlave, StreamKind::kDepth);              // true
//   camera->stream(StreamKind::kDepth)->find_size(848, 480)->rates_hz;  // 15, 30, 60, 90
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/choices.h"

namespace simbench::scenarios {

struct ImageSize {
  std::int64_t width = 0;
  std::int64_t height = 0;
  double focal_px = 0;           // depth: of the rectified image, in pixels (0: not known)
  std::vector<double> rates_hz;  // ascending
};

struct StreamProfile {
  StreamKind kind{};
  std::string format;
  ShutterKind shutter{};
  double readout_periods = 0;  // rolling: readout as a share of the frame period
  double bytes_per_pixel = 0;
  std::vector<ImageSize> sizes;
  std::string source;

  const ImageSize* find_size(std::int64_t width, std::int64_t height) const;  // null: none
};

struct SyncModeProfile {
  SyncMode mode{};
  std::vector<StreamKind> triggered;  // streams that follow the pulses
  // Their exposures begin at the pulse, and wait for it without limit; else they end a mode period
  // after it (genlock: always true of it, whatever this is).
  bool begins_at_pulse = false;
};

struct StampProfile {
  std::string stamp;  // "sensor", "frame", "backend" or "arrival"
  std::string clock;  // "camera" or "host"
  std::string unit;
  std::optional<double> wraps_after_s;  // nothing: not documented
  std::string meaning;
  std::string source;
};

// Which controls of its frames the maker offers (algorithms/ports/frame_control.h).
struct FrameControlProfile {
  bool adjust_frame = false;
  bool insert_frame = false;
  bool frame_length = false;
  bool start_at = false;
  std::string source;
};

struct CameraProfile {
  std::string model;  // its name in a scenario
  std::string name;   // its maker's name for it
  std::string maker;
  std::vector<StreamProfile> streams;
  std::vector<SyncModeProfile> sync_modes;
  std::vector<double> sync_rates_hz;  // in modes other than default and genlock; empty: all
  std::string sync_wiring;
  std::string sync_source;
  std::vector<StampProfile> stamps;
  std::vector<double> typical_latency_ms;  // lowest and highest mean; empty: not documented
  std::string latency_source;
  std::optional<FrameControlProfile> frame_control;  // nothing: not known

  const StreamProfile* stream(StreamKind kind) const;     // null: the model has none
  const SyncModeProfile* sync_mode(SyncMode mode) const;  // null: the model does not have it
  // Whether exposures of that stream follow the pulses in that mode; false where there is none.
  bool triggers(SyncMode mode, StreamKind kind) const;
};

// In alphabetical order of the models.
const std::vector<CameraProfile>& camera_profiles();

// Null if there is no such model. Reads the file of the model alone.
const CameraProfile* find_camera_profile(std::string_view model);

// All profiles as one JSON array, as their files have them.
std::string camera_profiles_json();

}  // namespace simbench::scenarios
