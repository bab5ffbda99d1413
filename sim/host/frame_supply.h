// Where the frames come from that programs on the hosts read: the capture, which delivers them when
// it is asked to; and where their commands to cameras go.
//
//   FrameSupply supply;
//   supply.connect([&] { capture.catch_up(); }, [&] { expect_frame(); },
//                  [&](std::uint32_t, const FrameCommand&) {});
//   supply.catch_up();
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "sim/camera/steered_sensor.h"

namespace simbench::sim {

class FrameSupply {
 public:
  // Until then there are no frames, and commands have no effect.
  using Steer = std::function<void(std::uint32_t camera, const FrameCommand& command)>;
  void connect(std::function<void()> catch_up, std::function<void()> expect, Steer steer) {
    catch_up_ = std::move(catch_up);
    expect_ = std::move(expect);
    steer_ = std::move(steer);
  }

  // A program has opened the feed of its host's frames.
  void open() { is_open_ = true; }
  bool is_open() const { return is_open_; }

  // Fills the feeds with what was delivered until now.
  void catch_up() const {
    if (catch_up_) catch_up_();
  }
  // A program waits for a frame: the next ones are delivered at their instants.
  void expect() const {
    if (expect_) expect_();
  }

  // A command reaches a camera now.
  void steer(std::uint32_t camera, const FrameCommand& command) const {
    if (steer_) steer_(camera, command);
  }

 private:
  std::function<void()> catch_up_;
  std::function<void()> expect_;
  Steer steer_;
  bool is_open_ = false;
};

}  // namespace simbench::sim
