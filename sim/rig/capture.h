// A capture: trigger pulses, cameras, USB and the hosts' stamps, as typed events on the engine.
//
// The way of a frame, an event each:
//
//   pulse (or a free-running shutter) -> readout: the frame is offered to its USB controller
//     -> transfer complete -> delivery: stamped by its host and handed to the sink
//
// Everything random about a frame is drawn when its exposure begins, from streams of its own
// camera and stream, so pipelines of one seed see the same frames whatever their hosts' clocks do.
//
// The hosts' clocks are only read, by true time; which protocol disciplines them is not known here.
//
// Source: docs/design.md section 7, docs/reference/calibration.md section 2,
// docs/reference/d455.md. Cost: three events per frame and one per pulse; no allocation per event
// once frames in flight have found their slots.
//
//   Capture capture(scenario, seed, engine, clocks, sink);
//   sink.on_start(capture.layout());
//   capture.start(capture_start, [&] { engine.stop(); });
//   engine.run();
#ifndef SIMBENCH_SIM_RIG_CAPTURE_H_
#define SIMBENCH_SIM_RIG_CAPTURE_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "recording/recording.h"
#include "recording/world_observer.h"
#include "scenarios/scenario.h"
#include "sim/camera/auto_exposure.h"
#include "sim/camera/device_clock.h"
#include "sim/camera/shutter.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/engine.h"
#include "sim/engine/random.h"
#include "sim/host/host_load.h"
#include "sim/network/outages.h"
#include "sim/rig/frame_observer.h"
#include "sim/trigger/trigger_tree.h"
#include "sim/usb/host_stack.h"
#include "sim/usb/usb_controller.h"

namespace simbench::sim {

class Capture final : public EventHandler {
 public:
  // `clocks` holds the system clock of every host; all references outlive the capture.
  Capture(const scenarios::Scenario& scenario, std::uint64_t seed, Engine& engine,
          std::vector<SystemClock*> clocks, RecordingSink& sink);

  // What will be captured; known from the beginning.
  RigLayout layout() const;

  // From now on `observer`, which must outlive the capture's run, is told of every delivered frame,
  // after the recording.
  void observe_frames(FrameObserver& observer) { frame_observer_ = &observer; }
  // Likewise of the start, of every pulse and of every frame that was exposed; those that reach a
  // stopped host end there untold.
  void observe(WorldObserver& observer) { observer_ = &observer; }

  // The cameras are started at `at`, not before the engine's present. `on_end` is called when the
  // last frame has been delivered.
  void start(TrueTime at, std::function<void()> on_end);

  // What other parts of the rig may know of a capture that has been started.
  const TriggerTree& trigger() const { return trigger_; }
  std::int64_t last_slot() const { return last_slot_; }
  TrueTime end() const { return end_; }
  TrueTime camera_start(std::size_t camera) const { return camera_start(camera, start_); }
  DeviceClock& device_clock(std::size_t camera) { return device_clocks_[camera]; }
  bool vanished(std::uint32_t camera, TrueTime at) const;

  void handle(const Event& event) override;

 private:
  enum Kind : std::uint16_t {
    kPulse,         // subject: slot
    kShutterTimer,  // subject: stream
    kReadout,       // subject: frame in flight
    kTransferDone,  // subject: controller
    kDelivery,      // subject: frame in flight
    kFault,         // subject: index of the fault
    kEnd,
  };

  // One stream of one camera.
  struct Stream {
    std::uint32_t camera;
    std::uint32_t host;
    std::uint32_t controller;
    std::uint32_t index_on_controller;
    StreamKind kind;
    double bytes;
    double transfer_ns;  // alone on the bus
    Nanoseconds latency;
    Nanoseconds readout;  // of a rolling shutter
    TrueTime started;
    Shutter shutter;
    FrameDelays delays;
    RandomStream stamp_noise;
    RandomStream loss;
    RandomStream unsteadiness;
    TrueTime last_arrival;
    std::uint32_t counter = 0;
  };
  struct Controller {
    UsbController bus;
    TrueTime wake_up = TrueTime::max();  // of the event that counts; others are out of date
  };
  struct FrameInFlight {
    FrameRecord record;
    FrameTruth truth;
    std::uint32_t stream = 0;
    double kernel_copy_ns = 0;
    double delivery_ns = 0;
    TrueTime offered;
    TrueTime transferred;
    TrueTime copied;
  };

  void build_clocks(TrueTime at);
  void build_controllers();
  void build_streams(TrueTime at);
  Stream make_stream(std::size_t camera, std::size_t which, TrueTime at);
  Nanoseconds exposure_of(std::size_t camera) const;
  ShutterMode shutter_mode(const scenarios::Stream& stream) const;
  TrueTime camera_start(std::size_t camera, TrueTime at) const;

  void schedule_pulse(std::int64_t slot);
  void on_pulse(std::int64_t slot);
  void report_pulse(std::int64_t slot);
  void on_shutter_timer(std::uint32_t stream_id);
  void expose(std::uint32_t stream_id, const Exposure& exposure);
  double late_first_frame_ns(std::uint32_t camera, TrueTime at);
  void on_readout(std::uint32_t frame_id);
  void on_transfer_done(std::uint32_t controller_id);
  void wake_controller(std::uint32_t controller_id);
  void deliver_later(std::uint32_t frame_id);
  void on_delivery(std::uint32_t frame_id);
  void tell_lost(const Stream& stream, std::uint32_t counter, const Exposure& exposure) const;
  void tell(const FrameInFlight& frame, FrameFate fate) const;
  void on_fault(const scenarios::Fault& fault);
  std::uint32_t new_frame();
  void release_frame(std::uint32_t frame_id);
  void end_if_done();

  const scenarios::Scenario& scenario_;
  std::uint64_t seed_;
  Engine& engine_;
  HandlerId id_;
  std::vector<SystemClock*> clocks_;
  RecordingSink& sink_;
  FrameObserver* frame_observer_ = nullptr;
  WorldObserver* observer_ = nullptr;
  TriggerTree trigger_;
  std::vector<DeviceClock> device_clocks_;
  std::vector<AutoExposure> exposures_;  // of the cameras
  std::vector<Stream> streams_;
  std::vector<std::uint32_t> triggered_streams_;
  std::vector<Controller> controllers_;
  std::vector<HostJitter> host_jitter_;
  std::vector<HostLoad> host_loads_;
  Outages outages_;
  std::vector<FrameInFlight> frames_;
  std::vector<std::uint32_t> free_frames_;
  std::vector<bool> late_frame_seen_;  // per fault
  std::vector<Nanoseconds> host_errors_;
  TrueTime start_{};
  std::int64_t first_slot_ = 0;
  std::int64_t last_slot_ = 0;
  TrueTime end_{};  // no exposure begins after this
  Nanoseconds arrival_quantum_;
  bool pulses_over_ = false;
  std::function<void()> on_end_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_RIG_CAPTURE_H_
