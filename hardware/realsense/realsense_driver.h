// The RealSense cameras that are plugged into this host.
//
// Holds librealsense2's context and notifies opened cameras when they are unplugged and plugged in
// again. Its destruction takes librealsense2 about two seconds.
// Cameras are listed in the order of their serial numbers: librealsense2's own is not stable.
//
// Cameras may outlive the driver; they are then no longer notified.
// Errors: CameraError: librealsense2 does not start; no camera of this serial number (the message
// lists those found).
//
//   RealsenseDriver driver;
//   auto camera = driver.open("018322071234");
#pragma once

#include <librealsense2/rs.hpp>
#include <memory>
#include <string>
#include <vector>

#include "hardware/camera/camera.h"

namespace simbench::hardware {

class RealsenseDriver final : public CameraDriver {
 public:
  RealsenseDriver();
  // With the caller's context, to which software devices can be added. From 2.55 on librealsense2
  // lists such a device only while somebody holds the list that came with its arrival.
  explicit RealsenseDriver(const rs2::context& context);
  ~RealsenseDriver() override;

  std::vector<CameraInfo> list() override;
  std::unique_ptr<Camera> open(const std::string& serial) override;

 private:
  class State;
  std::shared_ptr<State> state_;
};

}  // namespace simbench::hardware
