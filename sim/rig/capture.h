// A capture: trigger pulses, cameras, USB and the hosts' stamps, as typed events on the engine.
//
// The events of a frame:
//
//   pulse (or a free-running shutter) -> readout: the frame is offered to its USB controller
//     -> transfer complete -> delivery: stamped by its host and passed to the sink
//
// All random numbers of a frame are drawn when its exposure begins, from streams of its own camera
// and stream, so pipelines of one seed get the same frames whatever their hosts' clocks do.
//
// The hosts' clocks are only read, by true time, whatever protocol disciplines them.
//
// Source: docs/design.md section 7, docs/reference/calibration.md section 2,
// docs/reference/d455.md. Cost: three events per frame and one per pulse; no allocation per event
// once frames in flight have found their slots.
//
//   Capture capture(scenario, seed, engine, clocks, outages, CaptureReports(sink));
//   sink.on_start(capture.layout());
//   capture.start(capture_start, [&] { engine.stop(); });
//   engine.run();
#ifndef SIMBENCH_SIM_RIG_CAPTURE_H_
#define SIMBENCH_SIM_RIG_CAPTURE_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "recording/recording.h"
#include "scenarios/scenario.h"
#include "sim/clock/system_clock.h"
#include "sim/engine/engine.h"
#include "sim/engine/slots.h"
#include "sim/faults/faults.h"
#include "sim/network/load.h"
#include "sim/rig/cameras.h"
#include "sim/rig/capture_reports.h"
#include "sim/trigger/trigger_tree.h"
#include "sim/usb/backend_stamp.h"
#include "sim/usb/host_stack.h"
#include "sim/usb/usb_controller.h"

namespace simbench::sim {

class Capture final : public EventHandler {
 public:
  // `clocks` holds the system clock of every host; all references outlive the capture.
  Capture(const scenarios::Scenario& scenario, std::uint64_t seed, Engine& engine,
          std::vector<SystemClock*> clocks, const Outages& outages, const CaptureReports& reports);

  // The layout of the recording; known from the beginning.
  RigLayout layout() const;

  // Starts the cameras at `at`, not before the engine's present. Calls `on_end` when the last frame
  // has been delivered.
  void start(TrueTime at, std::function<void()> on_end);

  // For other parts of the rig, after start().
  const TriggerTree& trigger() const { return trigger_; }
  std::int64_t last_slot() const { return last_slot_; }
  TrueTime end() const { return end_; }
  Cameras& cameras() { return cameras_; }
  const CameraFaults& camera_faults() const { return camera_faults_; }

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

  struct FrameInFlight {
    CapturedFrame frame;
    std::uint32_t stream = 0;
    double kernel_copy_ns = 0;
    double delivery_ns = 0;
  };
  // A host's effects on all of its frames.
  struct HostSide {
    HostJitter jitter;
    HostLoad load;
  };

  void schedule_pulse(std::int64_t slot);
  void on_pulse(std::int64_t slot);
  void record_pulse(std::int64_t slot);
  void on_shutter_timer(std::uint32_t stream_id);
  Exposure with_unsteady_start(CameraStream& stream, const Exposure& planned) const;
  void expose(std::uint32_t stream_id, const Exposure& planned);
  void on_readout(std::uint32_t frame_id);
  void on_transfer_done(std::uint32_t controller_id);
  void wake_controller(std::uint32_t controller_id);
  void deliver_later(std::uint32_t frame_id);
  void on_delivery(std::uint32_t frame_id);
  void stamp(CapturedFrame& frame);
  void on_fault(const scenarios::Fault& fault);
  void end_if_done();

  const scenarios::Scenario& scenario_;
  std::uint64_t seed_;
  Engine& engine_;
  HandlerId id_;
  std::vector<SystemClock*> clocks_;
  CaptureReports reports_;
  TriggerTree trigger_;
  Cameras cameras_;
  std::vector<UsbController> controllers_;
  std::vector<HostSide> host_sides_;
  const Outages& outages_;
  CameraFaults camera_faults_;
  Slots<FrameInFlight> frames_;
  std::vector<Nanoseconds> host_errors_;
  std::int64_t first_slot_ = 0;
  std::int64_t last_slot_ = 0;
  TrueTime end_{};  // no exposure begins after this
  Nanoseconds arrival_quantum_;
  BackendStamps backend_stamps_;
  TrueTime start_{};
  bool pulses_over_ = false;
  std::function<void()> on_end_;
};

}  // namespace simbench::sim

#endif  // SIMBENCH_SIM_RIG_CAPTURE_H_
