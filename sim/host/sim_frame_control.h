// The control of a simulated camera's frames, for the programs of its host.
//
// A control takes its delay to the camera, on the engine, and may be lost; when it comes, the
// world's camera latches it (sim/camera/steered_sensor.h). The draws of a control are keyed by the
// camera and the number of the control. What the camera cannot do is refused before it is sent.
//
// start_at() follows the host's system clock: it waits until shortly before the time, and reads off
// then at what instant the clock will show it.
//
// Frames come as they are delivered, through the rig (FrameSupply): at the instant of the delivery,
// while a coroutine waits.
//
//   SimFrameControl control(host, 3, scenario);
//   const FrameControlReply reply = co_await control.adjust_frame(from_ms(2));
#pragma once

#include <cstdint>
#include <optional>

#include "algorithms/ports/frame_control.h"
#include "clocks/frame_lengths.h"
#include "scenarios/scenario.h"
#include "sim/camera/steered_sensor.h"
#include "sim/host/sim_host.h"

namespace simbench::sim {

class SimFrameControl final : public FrameControl {
 public:
  // `host` must outlive the control.
  SimFrameControl(SimHost& host, std::uint32_t camera, const scenarios::Scenario& scenario);

  std::uint32_t camera() const override { return camera_; }
  const FrameControlLimits& limits() const override { return requests_.limits(); }
  Task<std::optional<FrameArrival>> next_frame(SteadyTime deadline) override;
  Task<FrameControlReply> start_at(HostTime at) override;

  // The camera's own queue.
  void push(FrameArrival frame);
  // The next frame brings it along.
  void read_clock(const CameraClockReading& reading) { reading_ = reading; }
  bool is_awaited() const { return feed_.is_awaited(); }

 private:
  Task<FrameControlReply> change(FrameControlKind kind, Nanoseconds length) override;

  SimHost& host_;
  std::uint32_t camera_;
  scenarios::FrameControlModel model_;
  clocks::FrameRequests requests_;
  std::uint64_t sent_ = 0;
  std::optional<CameraClockReading> reading_;
  SimFrameFeed feed_;
};

}  // namespace simbench::sim
