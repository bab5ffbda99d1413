// A recording: all results of a capture as plain data, and the interface that passes it on.
//
// This is the waist of simbench. Every backend (the simulator, a real rig, a replayed file) passes
// its capture to a RecordingSink, in order of delivery, and nothing after it depends on which
// backend it was. Only the simulator passes truth (FrameTruth, PulseTruth).
//
// A capture is streamed, so that one of 18,000 cameras is scored without being held in memory.
// KeptRecording (recording/event.h) holds all of it and can play it to another sink.
//
// Frames come in blocks; all else is a RecordingEvent, so a sink handles the events it wants:
//
//   struct PollCount final : RecordingSink {
//     void on_start(const RigLayout&) override {}
//     void on_frames(std::span<const FrameRecord>, std::span<const FrameTruth>) override {}
//     void on_event(const RecordingEvent& event) override {
//       if (std::holds_alternative<DevicePoll>(event)) ++polls;
//     }
//     int polls = 0;
//   };
//
// Units: stamps in their own time base (algorithms/ports/time.h), exposure in microseconds.
// Source: docs/design.md section 2; the four stamps: docs/reference/d455.md section 1.
//
//   KeptRecording kept;
//   source.record(request, kept);       // any RecordingSource
//   kept.play(scorer);                  // any other RecordingSink
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "algorithms/ports/clock_adjustment.h"
#include "algorithms/ports/exchange.h"
#include "algorithms/ports/time.h"
#include "recording/share_done.h"
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

  TrueTime mid_exposure() const {
    return TrueTime(Nanoseconds(std::midpoint(exposure_start.time_since_epoch().count(),
                                              exposure_end.time_since_epoch().count())));
  }
};

// The truth of a trigger pulse; simulated captures only.
struct PulseTruth {
  std::int64_t pulse = 0;
  TrueTime at{};
  std::vector<Nanoseconds> host_errors{};  // system clock minus the master's, per host; [0] is 0
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

// The four stamps of one exchange of host synchronisation, as one of its two hosts has them.
struct ExchangeEvent {
  std::uint32_t host = 0;
  Exchange exchange;
};

// A second of GNSS time as a host's PPS line showed it: the receiver's message says which second,
// the interrupt came some time later.
struct PulseSighting {
  std::uint32_t host = 0;
  SteadyTime seen{};
  Nanoseconds gnss{};  // of the pulse; a zero of its own, the same for all hosts
};

// Whatever a capture reports besides frames:
//
//   PulseTruth       a trigger pulse and the errors of the clocks then; simulated captures only
//   ClockAdjustment  a host's clock or its rate was set; the first of a host is its initial setting
//   DevicePoll       a reading of a camera's clock
//   ExchangeEvent    an exchange of host synchronisation
//   SyncOutcome      how host synchronisation ended on a slave
//   SessionDelays    what a slave measured in a pass of a session of Algorithms 1 and 2, and added
//   ProgramFailure   a real program of a host ended too early
//   PulseSighting    a host that reads its PPS line saw a second of GNSS time
//   AlignmentReport  how far a steered camera is; steered captures only
//   LedSighting      captures with a clock of LEDs only; after its frame, before the camera's next
//
// A new kind is a struct, a place here and its line of text (event_text.cc): what keeps, writes,
// forwards and forks events takes it from there.
using RecordingEvent =
    std::variant<PulseTruth, ClockAdjustment, DevicePoll, ExchangeEvent, SyncOutcome,
                 AlignmentReport, LedSighting, SessionDelays, ProgramFailure, PulseSighting>;

// Handles an event by its type:
//
//   std::visit(Overloaded{[&](const DevicePoll& poll) { sink.on_event(poll); },
//                         [](const auto&) {}},
//              event);
template <class... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <class... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

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

// Who receives a capture, in order of delivery. Frames and events alternate as they happened.
//
// Whoever produces events often keeps one and changes it for the next call, so that a pulse with
// its errors allocates nothing; a sink copies what it keeps.
class RecordingSink {
 public:
  virtual ~RecordingSink() = default;
  virtual void on_start(const RigLayout& layout) = 0;
  // Frames with no event between them, the warm-up's too; `truths` is empty on a real rig, else as
  // long as `frames`. How frames come in blocks tells nothing: a block may be one frame.
  virtual void on_frames(std::span<const FrameRecord> frames,
                         std::span<const FrameTruth> truths) = 0;
  virtual void on_event(const RecordingEvent& event) = 0;

  // A block of one frame; `truth` is null on a real rig.
  void on_frame(const FrameRecord& frame, const FrameTruth* truth) {
    on_frames({&frame, 1}, {truth, truth != nullptr ? std::size_t{1} : std::size_t{0}});
  }
};

// Calls visit(frame, truth) for each frame of a block; `truth` is null on a real rig.
template <class Visit>
void for_each_frame(std::span<const FrameRecord> frames, std::span<const FrameTruth> truths,
                    const Visit& visit) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    visit(frames[i], truths.empty() ? nullptr : &truths[i]);
  }
}

// Which capture to make: the pipeline decides which host_sync runs and which load is drawn.
struct RecordingRequest {
  std::uint64_t seed = 1;
  std::string pipeline;           // by name, one of the scenario's
  HostSync* host_sync = nullptr;  // the algorithm to run; outlives the call; null: none runs
  // What steers the exposures, likewise; null: nothing does.
  CaptureAlignment* capture_alignment = nullptr;
  // Notified of what only a simulated world can show (world_observer.h); outlives the call. Never
  // changes the recording; each frame is then a block of its own, followed by what the world shows
  // of it.
  WorldObserver* observer = nullptr;
  // Once true, a simulated world ends with RecordingCancelled; outlives the call. A signal handler
  // may set it.
  const std::atomic<bool>* cancel = nullptr;
  ShareDone share_done{};  // of a simulated world; empty: nobody asks
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
  // Real programs that ended too early, which are among the notes: what the run has is not theirs.
  std::vector<ProgramFailure> program_failures{};
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
  // Whether it runs the request's host_sync; a recorded capture had its own, so that the programs
  // of a pipeline need not be there.
  virtual bool runs_host_sync() const { return true; }
};

}  // namespace simbench
