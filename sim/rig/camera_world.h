// The cameras' half of a world: trigger pulses, exposures, USB, deliveries and polls of device
// clocks, in true time since the cameras' start, which is true zero here.
//
// The way of a frame:
//
//   pulse (or a free-running shutter) -> readout: the frame is offered to its USB controller
//     -> transfer complete -> delivery to its host -> the program takes it
//     (sim/host/reader_queue.h)
//
// Problem: all pipelines of a scenario and a seed are to meet the same frames, and a rig of 18
// cameras makes thousands of them a second of true time.
//
// Naive attempt: every stage of every frame is an event of the engine, in every run.
//
// Why it fails: nearly all events of a run are then stages of frames. The queue sorts what is
// sorted by nature, the frames of all hosts take turns in the cache, and every pipeline repeats
// what no pipeline can change.
//
// Key idea: none of it depends on a clock, nor on when the capture starts (but for bursts of load
// on the hosts, which come and go in true time: depends_on_start()). This half is therefore made
// once for a scenario and a seed, without events, and read by every capture (sim/rig/capture.h):
// the cameras stamp its frames with their clocks (sim/rig/camera_stamps.h), the hosts with theirs.
// It is made period by period, a period being the time from one pulse of the main trigger to the
// next, and in a period host by host, since no host's frames meet another's and a host's cameras
// fit into the cache: exposures by the pulse and by shutters that run free, transfers of its
// controllers, delays of what was transferred. The deliveries of all hosts are sorted then. What is
// under way when the period ends goes on in the next.
//
// Contract:
//  - Periods are kept while all of them together take less than `kept_bytes`; then only the last
//    one is, and the half can be read only once.
//  - All random numbers of a frame are drawn when its exposure begins, from streams of its own
//    camera and stream.
//  - In one nanosecond, a transfer that ends makes room before a frame is offered. Frames are
//    delivered in the order in which their transfers ended, then host by host.
//  - Steered cameras (algorithms/ports/capture_alignment.h) depend on what the hosts do: their half
//    is of one capture alone, is read while it runs, and is made in small parts of a period: at
//    most one part is made ahead of the hosts. steer() hands a command to a camera.
//  - Frames of cameras that no trigger reaches belong to the pulse of the reference camera's
//    exposure that is nearest (sim/rig/reference_pulses.h).
//
// Source: docs/design.md section 7, docs/reference/calibration.md section 2,
// docs/reference/d455.md. Cost: three sorts a period; no allocation in steady state unless periods
// are kept.
//
//   CameraWorld world(scenario, seed);
//   for (std::size_t i = 0; const CameraPeriod* period = world.period(i); ++i) use(*period);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "laws/usb_controller.h"
#include "recording/recording.h"
#include "recording/world_observer.h"
#include "scenarios/scenario.h"
#include "sim/engine/engine.h"
#include "sim/engine/slots.h"
#include "sim/faults/faults.h"
#include "sim/host/reader_queue.h"
#include "sim/network/load.h"
#include "sim/rig/cameras.h"
#include "sim/rig/clock_polls.h"
#include "sim/rig/reference_pulses.h"
#include "sim/trigger/trigger_tree.h"
#include "sim/usb/host_stack.h"

namespace simbench::sim {

// A frame that was delivered or lost.
struct SimFrame {
  std::uint32_t stream = 0;  // of SimCameras::stream()
  std::uint32_t camera = 0;
  std::uint32_t host = 0;
  std::uint32_t counter = 0;  // of its stream; a gap is a lost frame
  std::uint32_t exposure_us = 0;
  FrameFate fate = FrameFate::kDelivered;
  StreamKind kind{};
  double stamp_noise_ns = 0;      // of the camera's own stamps
  std::int64_t pulse = kNoPulse;  // the slot that it belongs to
  TrueTime exposure_start{};
  TrueTime exposure_end{};
  TrueTime readout_start{};
  TrueTime offered{};      // to its USB controller
  TrueTime transferred{};  // the last byte is with the host
  TrueTime copied{};       // to the kernel
  TrueTime at{};           // delivered to the program, or lost

  TrueTime mid_exposure() const { return exposure_start + (exposure_end - exposure_start) / 2; }
};

// What happens from one pulse to the next, without what happens at `end`.
struct CameraPeriod {
  std::optional<ObservedPulse> pulse;  // at its beginning; none: missing, or before the first
  std::vector<SimFrame> frames;        // in the order of `at`
  std::vector<CameraPoll> polls;       // in the order of `end`
  TrueTime end{};
};

// The slots of the main trigger's pulses whose frames are evaluated.
struct EvaluatedSlots {
  std::int64_t first = 0;
  std::int64_t last = 0;
};
EvaluatedSlots evaluated_slots(const scenarios::Scenario& scenario);

class CameraWorld {
 public:
  static constexpr std::size_t kKeptBytes = 64 << 20;

  // The half of a capture that starts at `start`. The scenario must outlive this. The limit of
  // events alone counts.
  CameraWorld(const scenarios::Scenario& scenario, std::uint64_t seed, TrueTime start = {},
              const EngineLimits& limits = {}, std::size_t kept_bytes = kKeptBytes,
              Steering steering = Steering::kNone);
  CameraWorld(const CameraWorld&) = delete;
  CameraWorld& operator=(const CameraWorld&) = delete;

  // Period `index`, until the next one is asked for; null after the last. If not all are kept, they
  // can only be asked for in turn. Throws EngineLimitReached.
  const CameraPeriod* period(std::size_t index);
  // Whether all periods until now are kept.
  bool is_whole() const { return dropped_ == 0; }

  static bool depends_on_start(const scenarios::Scenario& scenario) {
    return scenario.hosts.load_burst.rate_hz > 0 || scenario.cameras.frame_control.has_value();
  }
  // Whether what is made depends on commands: it must not be made before it is due.
  bool is_steered() const { return parts_ > 1; }
  // The command reaches the camera at `at`, which is not past the part that was made last.
  void steer(std::uint32_t camera, const FrameCommand& command, TrueTime at);

  std::uint64_t seed() const { return seed_; }
  TrueTime start() const { return start_; }
  // No exposure begins after this.
  TrueTime last_exposure() const { return last_exposure_; }
  // After the last period: when the last frame is delivered or lost, but not before the former.
  TrueTime end() const { return end_; }
  // All pulses, readouts, transfers, deliveries and polls of the periods until now.
  std::uint64_t events() const { return events_; }
  std::uint64_t trace_hash() const { return trace_hash_; }

  const SimCameras& cameras() const { return cameras_; }

 private:
  struct FrameInFlight {
    SimFrame frame;
    double kernel_copy_ns = 0;
    double delivery_ns = 0;
  };
  // A frame at the end of a stage: offered, transferred or delivered.
  struct Step {
    // To be made in its place: a copy would wait for what was just written.
    Step(TrueTime ends, TrueTime when_transferred, std::uint64_t number, std::uint32_t id,
         std::uint32_t on_controller)
        : at(ends), transferred(when_transferred), order(number), frame(id), place(on_controller) {}
    TrueTime at;
    TrueTime transferred;
    std::uint64_t order = 0;  // among all steps
    std::uint32_t frame = 0;  // in flight
    std::uint32_t place = 0;  // of its stream on the controller
  };
  struct Bus {
    UsbController controller;
    std::vector<Step> offers;
    std::uint32_t first_stream = 0;  // of the first camera; others of its kind are alike
  };
  struct HostSide {
    HostJitter jitter;  // of all of its frames
    HostLoad load;
    // From here to before there.
    std::uint32_t first_stream = 0;
    std::uint32_t end_stream = 0;
    std::uint32_t first_bus = 0;
    std::uint32_t end_bus = 0;
    TrueTime next_timer;  // not later than the earliest of its shutters'
  };

  static void sort(std::vector<Step>& steps);
  void add(std::vector<Step>& steps, TrueTime at, TrueTime transferred, std::uint32_t frame,
           std::uint32_t place = 0) {
    steps.emplace_back(at, transferred, events_++, frame, place);
  }
  void make_hosts();
  void make_period(CameraPeriod& period);
  // Begins the next part of a period, and returns when it ends.
  TrueTime begin_part(CameraPeriod& period);
  // Slot next_slot_, not before `earliest`.
  void plan_slot(TrueTime earliest);
  std::optional<ObservedPulse> begin_slot();
  void expose_by_pulse(const HostSide& host, const ObservedPulse& pulse);
  void expose_by_timers(HostSide& host, TrueTime before);
  std::uint32_t next_timer(std::uint32_t first) const;
  Exposure with_unsteady_start(SimStream& stream, const Exposure& planned) const;
  void expose(std::uint32_t stream_id, const Exposure& planned, TrueTime now);
  void transfer(const HostSide& host, TrueTime before);
  void transfer(Bus& bus, TrueTime before);
  static bool is_each_stream_once(const std::vector<Step>& offers);
  std::vector<Step>::iterator pass(Bus& bus, std::vector<Step>::iterator next, TrueTime before);
  void offer(Bus& bus, const Step& offer);
  void deliver(HostSide& host, const Step& transferred);
  // What the programs of a host take before that, of the streams that are read.
  void read(const HostSide& host, TrueTime before);
  void end_read_frames();
  void hand_out_frames(TrueTime before, std::vector<SimFrame>& frames);

  const scenarios::Scenario& scenario_;
  std::uint64_t seed_;
  TrueTime start_;
  std::uint64_t max_events_;
  EvaluatedSlots slots_;
  int parts_;              // of a period
  std::int64_t end_slot_;  // the last one
  std::uint32_t kinds_;    // streams of a camera
  Nanoseconds unstable_start_;
  TriggerTree trigger_;
  SimCameras cameras_;
  CameraFaults camera_faults_;
  std::vector<Bus> buses_;
  std::vector<HostSide> hosts_;
  Slots<FrameInFlight> frames_;
  std::vector<Step> transferred_;     // of one host
  std::vector<Step> ended_;           // delivered or lost
  std::vector<ReaderQueue> readers_;  // of each stream; none where programs are never busy
  std::vector<ReaderQueue::Outcome> read_;
  TrueTime last_exposure_;
  ClockPolls polls_;
  TrueTime end_;
  std::int64_t next_slot_ = 0;
  TrueTime next_slot_at_{};
  bool next_slot_has_pulse_ = false;
  TrueTime slot_at_{};  // of the present slot
  int part_ = 0;        // the next one
  TrueTime made_until_{};
  std::optional<ReferencePulses> reference_;  // where no trigger reaches the cameras
  bool has_begun_ = false;
  bool is_over_ = false;
  std::uint64_t events_ = 0;
  std::uint64_t trace_hash_ = 0;

  std::size_t kept_bytes_;
  std::size_t bytes_ = 0;
  std::size_t dropped_ = 0;           // periods before the first of these
  std::deque<CameraPeriod> periods_;  // a deque: a period stays where it is
};

}  // namespace simbench::sim
