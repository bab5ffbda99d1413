// A RealSense camera as a Camera (hardware/camera/camera.h), over a device handle.
//
// The handle may be any rs2::device, also an rs2::software_device. Options and profiles are set by
// realsense_settings.h, stamps read by realsense_frame.h, streams watched by
// hardware/camera/stream_watch.h. Images are not read.
//
// A camera that is unplugged while it is started is restarted, with the same settings, when its
// driver hands over its new device.
//
// Contract
//  - librealsense's callback reads `arrived` first.
//  - Handlers run one at a time, also those of two sensors, and must not call stop().
//  - unplugged() and plugged_in() may be called by any thread.
//
// Errors: CameraError: those of realsense_settings.h, a start without configure(), a second start,
// a device that another program streams from or that is unplugged. rs2::error never leaves it.
//
//   RealsenseCamera camera(device);
//   camera.configure(settings);
//   camera.start(on_frame, on_event);
#pragma once

#include <librealsense2/rs.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "hardware/camera/camera.h"
#include "hardware/realsense/realsense_settings.h"

namespace simbench::hardware {

// Serial number, name, firmware and USB type, as far as the device has them.
CameraInfo realsense_info(const rs2::device& device);

class RealsenseCamera : public Camera {
 public:
  explicit RealsenseCamera(const rs2::device& device);
  ~RealsenseCamera() override;
  RealsenseCamera(const RealsenseCamera&) = delete;
  RealsenseCamera& operator=(const RealsenseCamera&) = delete;

  const CameraInfo& info() const override { return info_; }
  void configure(const CameraSettings& settings) override;
  void start(FrameHandler on_frame, CameraEventHandler on_event) override;
  void stop() override;

  rs2::device device() const;
  void unplugged();
  // `device` is the same camera's.
  void plugged_in(const rs2::device& device);

 private:
  class Outlet;  // to the handlers

  void open_sensors();
  void close_sensors();

  CameraInfo info_;
  std::shared_ptr<Outlet> outlet_;
  mutable std::mutex mutex_;  // guards what follows
  rs2::device device_;
  bool present_ = true;
  std::optional<CameraSettings> settings_;
  std::vector<ChosenSensor> sensors_;
  std::size_t opened_ = 0;  // of sensors_
  bool started_ = false;
};

}  // namespace simbench::hardware
