// The control of the frames of one of a node's cameras: algorithms/ports/frame_control.h over a
// CameraSteering.
//
// start_at() follows the host's system clock: it waits until shortly before the time, and reads off
// then at what instant the clock will show it. The other controls reach the camera at once.
// One thread, the one that runs `context`.
//
//   RealFrameControl control({context, clock, host}, 3, camera.steering());
//   const FrameControlReply reply = co_await control.adjust_frame(from_ms(2));
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <optional>

#include "algorithms/ports/frame_control.h"
#include "hardware/camera/camera.h"
#include "hardware/clock/node_clock.h"
#include "hardware/node/node_frame_feed.h"

namespace simbench::hardware {

class RealFrameControl final : public FrameControl {
 public:
  // All outlive it.
  struct Place {
    boost::asio::io_context& context;
    NodeClock& clock;
    Host& host;
  };

  // `camera`: its number on the rig.
  RealFrameControl(const Place& place, std::uint32_t camera,
                   std::shared_ptr<CameraSteering> steering);

  std::uint32_t camera() const override { return camera_; }
  const FrameControlLimits& limits() const override { return steering_->limits(); }
  Task<std::optional<FrameArrival>> next_frame(SteadyTime deadline) override;
  Task<FrameControlReply> start_at(HostTime at) override;

  // A frame of the camera.
  void deliver(const FrameArrival& frame) { frames_.deliver(frame); }

 private:
  Task<FrameControlReply> change(FrameControlKind kind, Nanoseconds length) override;
  NodeClock& clock_;
  Host& host_;
  std::uint32_t camera_;
  std::shared_ptr<CameraSteering> steering_;
  NodeFrameFeed frames_;
};

}  // namespace simbench::hardware
