// A recording: all results of a capture as plain data, and the interface that passes it on.
//
// This is the waist of simbench. Every backend (the simulator, a real rig, a replayed file) passes
// its capture to a RecordingSink, in order of delivery, and nothing after it depends on which
// backend it was. Only the simulator passes truth (FrameTruth, PulseTruth).
//
// A capture is streamed, so that one of 18,000 cameras is scored without being held in memory.
// KeptRecording (recording/event.h) holds all of it and can play it to another sink.
//
// Units: stamps in their own time base (algorithms/ports/time.h), exposure in microseconds.
// Source: docs/design.md section 2; the four stamps: docs/reference/d455.md section 1.
//
//   KeptRecording kept;
//   source.record(request, kept);       // any RecordingSource
//   kept.play(scorer);                  // any other RecordingSink
#ifndef SIMBENCH_RECORDING_RECORDING_H_
#define SIMBENCH_RECORDING_RECORDING_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithms/ports/clock_adjustment.h"
#include "algorithms/ports/exchange.h"
#include "algorithms/ports/time.h"
#include "recording/true_time.h"
#include "scenarios/choices.h"

namespace simbench {

class CaptureAlignment;
class HostSync;
class WorldObserver;

using scenarios::StreamKind;
enum class StampDomain : std::uint8_t { kHardwareClock, kSystemTime, kGlobalTime };

// One frame as its host received it.
struct FrameRecord {
  std::uint32_t camera = 0;
  StreamKind stream = StreamKind::kDepth;
  StampDomain domain = StampDomain::kHardwareClock;
  std::uint32_t counter = 0;  // the camera's frame counter; a gap is a lost frame
  std::uint32_t exposure_us = 0;
  DeviceStamp sensor;           // middle of the exposure, device clock
  DeviceStamp frame;            // start of readout and transmission, device clock
  HostTime backend{};           // copied to the kernel, host's system clock, as the SDK has it
  HostTime arrival{};           // delivered, host's system clock, in steps of the arrival quantum
  SteadyTime arrival_steady{};  // the same instant on the host's steady clock
};

// The truth of a frame; simulated captures only.
struct FrameTruth {
  std::int64_t pulse = -1;  // index of the trigger pulse that exposed it; -1: free-running
  TrueTime exposure_start{};
  TrueTime exposure_end{};
  HostTime reference{};     // master's clock at mid-exposure: the ideal global stamp
  HostTime own_host{};      // the camera's own host's clock at mid-exposure
  SteadyTime own_steady{};  // the same host's steady clock at mid-exposure
  HostTime delivered{};     // master's clock when the host had the frame

  TrueTime mid_exposure() const { return exposure_start + (exposure_end - exposure_start) / 2; }
};

// The truth of a trigger pulse; simulated captures only.
struct PulseTruth {
  std::int64_t pulse = 0;
  TrueTime at{};
  std::span<const Nanoseconds> host_errors;  // system clock minus the master's, per host; [0] is 0
};

// A reading of a camera's clock over its control interface, at some instant between the readings t0
// and t1 of the host's clocks.
struct DevicePoll {
  std::uint32_t camera = 0;
  DeviceStamp device;
  HostTime t0{};
  HostTime t1{};
  SteadyTime t0_steady{};
  SteadyTime t1_steady{};
};

// What an image shows of a clock of LEDs: those that were lit during the exposure, an arc from the
// begin of the first one's step to the end of the last one's, on the clock's own time. Read from
// the image, so a reading may be wrong.
struct LedSighting {
  std::uint32_t camera = 0;
  DeviceStamp sensor;  // of the frame, which was reported just before
  std::int64_t led_start_ns = 0;
  std::int64_t led_end_ns = 0;

  Nanoseconds middle() const { return Nanoseconds(std::midpoint(led_start_ns, led_end_ns)); }
};

struct CameraLayout {
  std::uint32_t host = 0;
};

// The rig and the capture, known before the first frame.
struct RigLayout {
  std::uint32_t hosts = 0;
  std::vector<CameraLayout> cameras;
  double frame_rate_hz = 0;      // of the frames that should arrive
  std::int64_t first_pulse = 0;  // evaluated pulses: [first_pulse, first_pulse + pulses)
  std::int64_t pulses = 0;
};

class RecordingSink {
 public:
  virtual ~RecordingSink() = default;
  virtual void on_start(const RigLayout& layout) = 0;
  // Frames in order of delivery; `truth` is null on a real rig. Includes the warm-up.
  virtual void on_frame(const FrameRecord& frame, const FrameTruth* truth) = 0;
  // Frames with no other report between them, in order of delivery; `truths` is empty on a real
  // rig, else as long as `frames`. The same as on_frame() for each, and quicker.
  virtual void on_frames(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      on_frame(frames[i], truths.empty() ? nullptr : &truths[i]);
    }
  }
  virtual void on_pulse(const PulseTruth& truth) = 0;
  virtual void on_adjustment(const ClockAdjustment& adjustment) = 0;
  virtual void on_poll(const DevicePoll& poll) = 0;
  virtual void on_exchange(std::uint32_t host, const Exchange& exchange) = 0;
  virtual void on_outcome(const SyncOutcome& outcome) = 0;
  // Captures whose exposures are steered only; whoever does not care may ignore them.
  virtual void on_alignment(const AlignmentReport& /*report*/) {}
  // Captures with a clock of LEDs only; likewise. After its frame, before the camera's next one.
  virtual void on_led_sighting(const LedSighting& /*sighting*/) {}
};

// Which capture to make: the pipeline decides which host_sync runs and which load is drawn.
struct RecordingRequest {
  std::uint64_t seed = 1;
  std::string pipeline;           // by name, one of the scenario's
  HostSync* host_sync = nullptr;  // the algorithm to run; outlives the call; null: none runs
  // What steers the exposures, likewise; null: nothing does.
  CaptureAlignment* capture_alignment = nullptr;
  // Notified of what only a simulated world can show (world_observer.h); outlives the call. Never
  // changes the recording.
  WorldObserver* observer = nullptr;
  // Once true, a simulated world ends with RecordingCancelled; outlives the call. A signal handler
  // may set it.
  const std::atomic<bool>* cancel = nullptr;
};

// The cost of the recording; for the performance line.
struct RecordingCost {
  std::uint64_t events = 0;
  double simulated_seconds = 0;  // 0 on a real rig
  std::uint64_t trace_hash = 0;  // of the simulated events; 0 on a real rig
  // That the hosts sent each other, also the lost ones; unknown on a real rig.
  std::optional<std::uint64_t> messages{};
  // What went wrong, a line each for the user: a host that was lost, a camera that was unplugged.
  // The recording holds what came before.
  std::vector<std::string> notes{};
};

// A capture that could not be made; what() is one line that says why. Other captures of the same
// source may succeed, so an evaluation goes on with those.
class RecordingFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A capture that RecordingRequest::cancel ended.
class RecordingCancelled : public std::exception {
 public:
  const char* what() const noexcept override { return "cancelled"; }
};

// A backend. Errors: throws RecordingFailed, RecordingCancelled, or what its own header documents;
// the sink may have seen part of the capture.
class RecordingSource {
 public:
  virtual ~RecordingSource() = default;
  virtual RecordingCost record(const RecordingRequest& request, RecordingSink& sink) = 0;
};

}  // namespace simbench

#endif  // SIMBENCH_RECORDING_RECORDING_H_
