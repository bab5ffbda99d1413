// A capture: the cameras' half of a world, stamped by the clocks of its hosts' half.
//
// Problem: a recording has every frame as its host's clock stamps it, between the adjustments,
// exchanges and messages of that host, all in the order in which they happened.
//
// Naive attempt: each delivery of a frame, poll and pulse is an event, which reads the clocks.
//
// Why it fails: these events outnumber all others, and each finds the clock of another host, which
// the cache has lost since its last frame. Yet hardly anybody looks at a frame when it comes.
//
// Key idea: what happens to frames, polls and pulses in true time is known beforehand
// (CameraWorld), and what the cameras stamp (CameraStamps). The hosts' clocks can be read at any
// past instant. Nothing here therefore needs an event: what happened until now is stamped and
// reported, many frames at once, when somebody asks for it by catch_up().
//
// Contract: who must not come before what happened until now asks for it first:
//
//  - what else is recorded or observed: adjustments, exchanges, outcomes, messages;
//  - capture traffic, in which frames leave through the same ports as messages: each message;
//  - a program that reads the frames of its host's cameras. While it waits for one, each delivery
//    is an event (CaptureReports).
//
// The capture ends with an event at CameraWorld::end(). What reaches a stopped host ends there
// unreported.
//
// Cost: a comparison to catch up with nothing; a block of frames is stamped in one loop and
// reported at once (RecordingSink::on_frames). No allocation in steady state.
//
//   Capture capture(scenario, engine, clocks, outages, CaptureReports(sink));
//   sink.on_start(capture.layout());
//   CameraWorld world(scenario, seed, engine.now());
//   CameraStamps stamps(scenario, world, engine.now());
//   capture.start(world, stamps, [&] { engine.stop(); });
//   engine.run();
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "recording/recording.h"
#include "scenarios/scenario.h"
#include "sim/clock/clock_interface.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/engine.h"
#include "sim/faults/faults.h"
#include "sim/rig/camera_stamps.h"
#include "sim/rig/camera_world.h"
#include "sim/rig/capture_reports.h"
#include "sim/rig/led_clock.h"
#include "sim/usb/backend_stamp.h"

namespace simbench::sim {

class Capture {
 public:
  // `clocks` holds the system clock of every host, `interfaces` what polls read them through (none:
  // exactly); all references outlive the capture.
  Capture(const scenarios::Scenario& scenario, Engine& engine, std::vector<SystemClock*> clocks,
          const Outages& outages, const CaptureReports& reports,
          std::vector<ClockInterface> interfaces = {});
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  // The layout of the recording; known from the beginning.
  RigLayout layout() const;

  // Begins now, which is the start of the stamps. Calls `on_end` when all has been reported. Once
  // `cancel` is true, throws RecordingCancelled from whatever is called next.
  void start(CameraWorld& world, CameraStamps& stamps, std::function<void()> on_end,
             const std::atomic<bool>* cancel = nullptr);

  // Reports what has happened until now and has not been reported.
  void catch_up() {
    if (next_at_ <= engine_.now()) report_through(engine_.now());
  }
  // When the next thing happens; TrueTime::max() before the start and after the end.
  TrueTime next_at() const { return next_at_; }

 private:
  void step_clock(const scenarios::ClockStep& fault);
  void end();
  void begin_period(std::size_t number);
  TrueTime next_frame_at() const;
  TrueTime next_poll_at() const;
  TrueTime next_in_period(TrueTime now);
  // The instant of what happens in the world `since_start`.
  TrueTime date(TrueTime since_start) const { return since_start + shift_; }
  void report_through(TrueTime now);
  void report_pulse(const ObservedPulse& pulse);
  void report_poll(const CameraPoll& poll);
  void report_frames(TrueTime last);
  void report_block(std::size_t first, std::size_t end);
  void report_single(std::size_t number);
  void report_sighting(const SimFrame& frame);
  // Whether its host is stopped when a frame comes.
  bool is_stopped(const SimFrame& frame) const {
    return outages_.host_stopped(static_cast<PeerId>(frame.host), date(frame.at));
  }
  void stamp(const SimFrame& frame, const FrameStamps& stamps);
  // Reports those of the block that are not reported.
  void flush();

  const scenarios::Scenario& scenario_;
  Engine& engine_;
  std::vector<SystemClock*> clocks_;
  const Outages& outages_;
  CaptureReports reports_;
  EvaluatedSlots slots_;
  Granularity arrival_quantum_;
  BackendStamps backend_stamps_;
  std::vector<ClockInterface> interfaces_;
  bool stamps_on_host_;
  std::vector<SteadyTime> steady_starts_;  // what the hosts' steady clocks read at the start
  RecordingEvent pulse_event_;             // a PulseTruth, reused for every pulse
  std::function<void()> on_end_;
  std::optional<LedClock> led_clock_;  // from the start on, where there is one

  CameraWorld* world_ = nullptr;
  CameraStamps* stamps_ = nullptr;
  Nanoseconds shift_{};  // of the world's times
  const std::atomic<bool>* cancel_ = nullptr;
  TrueTime next_at_ = TrueTime::max();
  // What was reported of the present period.
  const CameraPeriod* period_ = nullptr;
  std::span<const FrameStamps> period_stamps_;
  std::size_t period_number_ = 0;
  bool is_pulse_reported_ = false;
  std::size_t frames_reported_ = 0;
  std::size_t polls_reported_ = 0;
  // A block of frames.
  std::vector<FrameRecord> records_;
  std::vector<FrameTruth> truths_;
  std::size_t flushed_ = 0;  // the first so many are reported
};

}  // namespace simbench::sim
