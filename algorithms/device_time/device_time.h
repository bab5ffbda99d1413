// Stage 2, device_time: when, on the host clock, was this frame exposed?
//
// An estimator turns one camera's stream of (sensor stamp, arrival stamp) into global stamps. One
// object per camera and stream; it gets the frames in order of delivery and has no access to other
// cameras, clocks or truth. It never waits, and its memory is bounded.
//
// Degenerate input (one frame, equal stamps, decreasing stamps) gives a documented fallback, never
// a NaN: see each estimator's header.
//
//   auto estimator = make_regression(RegressionWindow{30});
//   for (const DeviceSample& sample : frames) global.push_back(estimator->stamp(sample));
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "algorithms/ports/clock_adjustment.h"
#include "algorithms/ports/time.h"

namespace simbench {

struct DeviceSample {
  DeviceTime sensor{};          // middle of the exposure, unwrapped
  HostTime arrival{};           // delivery, on the host's system clock
  SteadyTime arrival_steady{};  // the same instant on the host's steady clock
  std::uint32_t exposure_us = 0;
};

// The camera's clock, read over its control interface at some instant from t0 to t1.
struct PollSample {
  DeviceTime device{};  // unwrapped with the camera's frames
  HostTime t0{};
  HostTime t1{};
  SteadyTime t0_steady{};
  SteadyTime t1_steady{};
};

// What a frame shows of a clock of LEDs that all cameras of the rig see (recording.h: LedSighting).
struct LedSample {
  DeviceTime sensor{};  // of the frame, unwrapped with the camera's others
  Nanoseconds led{};    // the middle of its lit LEDs, from the zero of the LED clock
};

struct CodedPulses;  // algorithms/coded_trigger/coded_pulses.h
class EstimatorBank;

class DeviceTimeEstimator {
 public:
  virtual ~DeviceTimeEstimator() = default;
  // The global stamp of the newest frame.
  virtual GlobalTime stamp(const DeviceSample& sample) = 0;
  // True for an estimator that needs the whole recording before its first stamp (offline): learn()
  // gets it once, in order, before stamp() is called for each frame.
  virtual bool offline() const { return false; }
  virtual void learn(std::span<const DeviceSample> /*recording*/) {}
  // True for an estimator that gets the frames of the capture's warm-up too. The others begin with
  // the first evaluated frame, as the paper's do: arrivals of cameras that are still unsteady and
  // share the bus differently would spoil the estimate.
  virtual bool from_first_frame() const { return false; }
  // A poll of the camera's clock, or a change of its host's system clock, in order with the frames.
  // An offline estimator gets all of them before learn().
  virtual void on_poll(const PollSample& /*poll*/) {}
  virtual void on_adjustment(const ClockAdjustment& /*adjustment*/) {}
  // A sighting of the LED clock, after its frame and likewise; also in the warm-up.
  virtual void on_led_sighting(const LedSample& /*sighting*/) {}
  // What the trigger's pulses are, if they are coded: once, before anything else.
  virtual void on_coded_pulses(const std::shared_ptr<const CodedPulses>& /*pulses*/) {}
  // True if stamps count from the camera's own first frame, or from another zero that all cameras
  // share, instead of a host's zero; to combine cameras, add one common anchor.
  virtual bool relative() const { return false; }
  // Whether the zero is one for all cameras: a host's, or another that they share. A camera's own
  // first frame is none.
  virtual bool shares_zero() const { return !relative(); }
  // For speed alone (estimator_bank.h): estimators like this fresh one for many cameras, or null.
  virtual std::unique_ptr<EstimatorBank> bank(std::size_t cameras) const;
};

}  // namespace simbench
