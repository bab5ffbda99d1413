// The sensor of a camera that runs free and whose frames a program may control.
//
// Frames follow each other: the readout of frame k + 1 begins when frame k has had its length, as
// the camera's own oscillator counts. A frame's exposure ends where its readout begins, so that a
// longer exposure begins earlier, and the exposure of the next frame lies within the length of this
// one: where it would not fit, it stretches the frame. Lengths are whole multiples of the
// granularity. A frame's exposure moves by the jitter, which the frames after it do not inherit.
//
// A command is latched by the frame that is in progress when it reaches the camera (its readout was
// the last to begin) and counts from the frame that follows `latency_frames` later. Exposures up to
// `made_until` are under way already: a command that would move one of them counts one frame later.
//
// A rolling shutter reads its rows one after the other, each exposed for the exposure time; an
// Exposure (shutter.h) lasts from the first row's begin to the last row's end.
//
// An ideal sensor exposes at the nominal instants of its trigger in place of commands, each to the
// next granule after a phase of its own.
//
// Times are true times since the cameras' start. Cost: O(log commands) a frame.
// Source: docs/reference/capture_alignment.md.
//
//   SteeredSensor sensor({}, OscillatorModel(20e-6), RandomStream(1, "jitter", 0), TrueTime{},
//                        TrueTime{});
//   sensor.latch({.kind = FrameControlKind::kFrameLength, .length = from_ms(33)}, TrueTime{},
//                TrueTime{});
//   const Exposure next = sensor.expose(from_ms(8));
#pragma once

#include <cstdint>
#include <deque>

#include "algorithms/ports/frame_control.h"
#include "clocks/frame_lengths.h"
#include "recording/true_time.h"
#include "sim/camera/shutter.h"
#include "sim/clock/oscillator.h"
#include "sim/engine/random.h"

namespace simbench::sim {

struct SteeredSensorSettings {
  FrameControlLimits limits;
  Nanoseconds readout{};
  double jitter_sigma_ns = 0;         // of the instant of a readout
  std::int64_t insert_stretches = 1;  // frames that get the length of an inserted one
  double insert_noise_sigma_ns = 0;   // of that length, each frame's own
  // Ideal: the instants at which the exposures should have their middle.
  bool is_ideal = false;
  TrueTime first_due{};
  double period_ns = 0;
};

// A control that has reached the camera.
struct FrameCommand {
  FrameControlKind kind = FrameControlKind::kFrameLength;
  Nanoseconds length{};  // of the frame, or by how much it is longer (kAdjustFrame)
  TrueTime at{};         // kStartAt: when the exposure begins
};

class SteeredSensor {
 public:
  // Its first exposure begins at `start`.
  SteeredSensor(const SteeredSensorSettings& settings, OscillatorModel oscillator,
                RandomStream draws, TrueTime start, TrueTime oscillator_zero);

  // When to call expose() next.
  TrueTime next_exposure() const { return next_exposure_; }
  // The exposure that begins then, of this exposure time. A later frame's may differ.
  Exposure expose(Nanoseconds exposure);

  // The command reaches the camera at `at`; exposures that begin before `made_until` stay.
  void latch(const FrameCommand& command, TrueTime at, TrueTime made_until);

 private:
  static constexpr std::int64_t kBeforeFirst = -1;

  Nanoseconds length_after(std::int64_t frame) const;
  Nanoseconds exposure_of(std::int64_t frame) const;
  TrueTime true_time(double device_ns, TrueTime near) const;
  double device_ns(TrueTime at) const;
  void plan_next();
  void plan_ideal();
  void restart(TrueTime at, TrueTime made_until);

  SteeredSensorSettings settings_;
  OscillatorModel oscillator_;
  RandomStream draws_;
  Nanoseconds zero_;  // of the oscillator, before the cameras' start
  double phase_ = 0;  // ideal: of its granules
  Nanoseconds exposure_;
  std::int64_t frame_ = kBeforeFirst;  // the last that was exposed
  double readout_device_ns_ = 0;       // where its readout begins
  TrueTime readout_{};
  TrueTime next_readout_{};
  double next_readout_device_ns_ = 0;
  TrueTime next_exposure_{};
  std::deque<TrueTime> readouts_;  // of the last frames, the newest is frame_
  clocks::FrameLengths lengths_;
};

}  // namespace simbench::sim
