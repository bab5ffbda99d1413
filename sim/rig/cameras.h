// The cameras of a rig, each with its exposure time, its image streams and its clock, and where
// their streams are plugged in: at which host, on which USB controller. They start at true zero.
//
// Cameras are numbered host by host (Scenario::host_of); usb/cameras_per_controller neighbours on a
// host share a controller. The values of a stream are drawn from random streams named after its
// camera and kind, so neither hosts nor pipelines change them.
//
// Delays differ from what a user measured for the model (/cameras/calibration): all of a seed alike
// before their transfers, each camera's after its own, so that it does not change how cameras share
// the bus.
//
// Source: docs/design.md section 7, docs/reference/calibration.md section 2 ("Cameras"),
// docs/reference/d455.md.
//
//   SimCameras cameras(scenario, seed);
//   for (SimStream& stream : cameras.streams()) timers.push_back(stream.shutter.next_timer());
//   std::vector<DeviceClock> clocks = device_clocks(scenario, seed, capture_start);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "algorithms/ports/capture_alignment.h"
#include "laws/usb_controller.h"
#include "recording/recording.h"
#include "recording/true_time.h"
#include "scenarios/scenario.h"
#include "sim/camera/auto_exposure.h"
#include "sim/camera/device_clock.h"
#include "sim/camera/shutter.h"
#include "sim/camera/steered_sensor.h"
#include "sim/engine/random.h"
#include "sim/usb/host_stack.h"

namespace simbench::sim {

// One image stream of one camera.
struct SimStream {
  std::uint32_t camera;
  std::uint32_t host;
  std::uint32_t controller;  // counted over all hosts
  std::uint32_t index_on_controller;
  StreamKind kind;
  std::int64_t pulses_per_frame;  // it gets one of so many
  double bytes;                   // of a frame
  double transfer_ns;             // of a frame that is alone on the bus
  Nanoseconds latency;            // from the end of the exposure to the offer to the bus
  Nanoseconds hold;               // so long after its offer a frame may be transferred
  Nanoseconds readout;            // of a rolling shutter
  double late_ns;                 // delivered later than a camera of the model is (may be negative)
  TrueTime started;               // to stream
  Shutter shutter;
  std::unique_ptr<SteeredSensor> sensor;  // in place of the shutter, where no trigger reaches it
  FrameDelays delays;
  double stamp_noise_sigma_ns;
  RandomStream stamp_noise;
  RandomStream loss;
  RandomStream unsteadiness;
  TrueTime last_arrival = TrueTime::min();
  std::uint32_t counter = 0;  // of the next frame

  // When a frame that is offered then must be through; Nanoseconds::max(): any time.
  Nanoseconds latest(Nanoseconds offered) const {
    return hold == Nanoseconds::max() ? hold : offered + hold;
  }
  bool runs_free() const { return sensor || shutter.mode() == ShutterMode::kFreeRunning; }
  // When it exposes without a pulse, or looks whether it should.
  TrueTime next_timer() const { return sensor ? sensor->next_exposure() : shutter.next_timer(); }
  std::optional<Exposure> on_timer(TrueTime now, Nanoseconds exposure) {
    if (sensor) return sensor->expose(exposure);
    shutter.set_exposure(exposure);
    return shutter.on_timer(now);
  }
};

// What is true of each camera, by its group (scenarios/camera_groups.h).
class CameraKinds {
 public:
  explicit CameraKinds(const scenarios::Cameras& cameras);
  const scenarios::Cameras& of(std::size_t camera) const { return group(camera).cameras; }
  std::int64_t pulses_per_frame(std::size_t camera) const { return group(camera).pulses_per_frame; }

 private:
  struct Group {
    scenarios::Cameras cameras;
    std::int64_t pulses_per_frame = 1;
  };
  const Group& group(std::size_t camera) const { return groups_[group_of_camera_[camera]]; }

  std::vector<std::size_t> group_of_camera_;
  std::vector<Group> groups_;
};

// How long after the capture's start this camera starts.
Nanoseconds start_delay(const scenarios::Scenario& scenario, std::uint64_t seed,
                        std::size_t camera);

// The clocks of the cameras of a capture that starts at `start`. Oscillators are functions of true
// time, so the same capture at another time has other stamps.
std::vector<DeviceClock> device_clocks(const scenarios::Scenario& scenario, std::uint64_t seed,
                                       TrueTime start);

// Whether the world's cameras have steered sensors: the frames can be controlled, and no trigger
// reaches the cameras.
bool has_steered_sensors(const scenarios::Scenario& scenario, Steering steering);

class SimCameras {
 public:
  // `scenario` must outlive the cameras. `start`: of the capture, which the oscillators of steered
  // sensors depend on.
  SimCameras(const scenarios::Scenario& scenario, std::uint64_t seed, TrueTime start = {},
             Steering steering = Steering::kNone);
  // The exposure time that a camera begins with at `at`.
  Nanoseconds exposure(std::size_t camera, TrueTime at) { return exposures_[camera].at(at); }

  SimStream& stream(std::uint32_t id) { return streams_[id]; }
  const SimStream& stream(std::uint32_t id) const { return streams_[id]; }
  std::vector<SimStream>& streams() { return streams_; }

  // A controller of its own for each group of cameras, as SimStream::controller counts them.
  std::vector<UsbController> make_controllers() const;

 private:
  SimStream make_stream(const DeviceClock& clock, std::size_t camera, std::size_t which) const;
  void add_sensors(TrueTime start, Steering steering);
  ShutterSettings shutter_settings(const DeviceClock& clock, std::size_t camera,
                                   const scenarios::Stream& profile) const;
  Nanoseconds first_exposure(std::size_t camera) const;

  const scenarios::Scenario& scenario_;
  CameraKinds kinds_;
  std::uint64_t seed_;
  std::uint32_t controllers_ = 0;
  std::vector<AutoExposureLoop> exposures_;
  std::vector<SimStream> streams_;
};

}  // namespace simbench::sim
